// A cluster of Slurm nodes on this machine. Each node has namespaces of its own: all its processes end
// together, as those of a node that loses power.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace brume::cli {

class Cluster {
 public:
  /// Why there can be none; empty: there can.
  static std::string obstacle();

  /// Nodes node1 to nodeN. `mounts` are commands of a shell that a node runs first, by its number from 1.
  /// Returns when all nodes are idle. Its files are in `folder`. Sets SLURM_CONF for this process, and moves
  /// it to a network of its own.
  Cluster(const std::filesystem::path& folder, int nodes, const std::map<int, std::string>& mounts);
  Cluster(const Cluster&) = delete;
  /// Ends all of it.
  ~Cluster();

  /// Ends all processes of a node at once.
  void kill(int node);

 private:
  pid_t start(const std::vector<std::string>& arguments, const std::string& name) const;
  void configure(int nodes) const;

  std::filesystem::path folder_;
  pid_t munge_ = 0, controller_ = 0;
  std::vector<pid_t> nodes_;
};

}  // namespace brume::cli
