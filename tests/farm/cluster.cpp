#include "tests/farm/cluster.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <net/if.h>
#include <sched.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <random>
#include <sstream>
#include <thread>

namespace brume::cli {
namespace {

namespace fs = std::filesystem;

bool is_program(const std::string& name) {
  for (const char* folder : {"/usr/bin/", "/usr/sbin/", "/bin/", "/sbin/"})
    if (::access((folder + name).c_str(), X_OK) == 0) return true;
  return false;
}

/// A network of this process and its children alone, in which every port is free.
void enter_own_network() {
  EXPECT_EQ(::unshare(CLONE_NEWNET), 0);
  const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  ifreq loopback{};
  std::strcpy(loopback.ifr_name, "lo");
  loopback.ifr_flags = IFF_UP | IFF_RUNNING;
  EXPECT_EQ(::ioctl(socket, SIOCSIFFLAGS, &loopback), 0);
  // Slurm listens only where a host has another address than 127.0.0.1 (AI_ADDRCONFIG of getaddrinfo).
  std::strcpy(loopback.ifr_name, "lo:1");
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK + 1);
  std::memcpy(&loopback.ifr_addr, &address, sizeof address);
  EXPECT_EQ(::ioctl(socket, SIOCSIFADDR, &loopback), 0);
  ::close(socket);
}

std::string output_of(const std::string& command) {
  std::string text;
  FILE* pipe = ::popen(command.c_str(), "r");
  std::array<char, 256> part{};
  while (pipe && ::fgets(part.data(), part.size(), pipe)) text += part.data();
  if (pipe) ::pclose(pipe);
  return text;
}

void end(pid_t& process, int signal) {
  if (process <= 0) return;
  ::kill(process, signal);
  ::waitpid(process, nullptr, 0);
  process = 0;
}

}  // namespace

std::string Cluster::obstacle() {
  for (const char* name : {"munged", "slurmctld", "slurmd", "sbatch", "unshare"})
    if (!is_program(name))
      return std::string(name) +
             " is not installed: script/bootstrap test installs slurmctld, slurmd and munge";
  if (::geteuid() != 0) return "takes root, for the namespaces of the nodes";
  if (std::system("unshare --net --mount --pid --fork --kill-child --mount-proc true 2> /dev/null") != 0)
    return "this system allows no namespaces";
  return "";
}

pid_t Cluster::start(const std::vector<std::string>& arguments, const std::string& name) const {
  std::vector<char*> words;
  for (const std::string& word : arguments) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  const std::string log = (folder_ / (name + ".out")).string();
  const pid_t parent = ::getpid(), child = ::fork();
  if (child != 0) return child;
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(126);
  const int file = ::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  ::dup2(file, STDOUT_FILENO);
  ::dup2(file, STDERR_FILENO);
  ::execvp(words[0], words.data());
  ::_exit(127);
}

void Cluster::configure(int nodes) const {
  std::array<char, 256> host{};
  EXPECT_EQ(::gethostname(host.data(), host.size() - 1), 0);
  std::string name = host.data();
  name.resize(std::min(name.size(), name.find('.')));
  constexpr int kFirstPort = 6817;
  const std::string folder = folder_.string();
  std::ofstream conf(folder_ / "slurm.conf");
  conf << "ClusterName=loopback\nSlurmctldHost=" << name << "(127.0.0.1)\nSlurmUser=root\n"
       << "AuthType=auth/munge\nCredType=cred/munge\nAuthInfo=socket=" << folder << "/munge.socket\n"
       << "SlurmctldPort=" << kFirstPort << "\nStateSaveLocation=" << folder << "/state\n"
       << "SlurmdSpoolDir=" << folder << "/spool/%n\nSlurmctldPidFile=" << folder << "/slurmctld.pid\n"
       << "SlurmdPidFile=" << folder << "/%n.pid\nSlurmdLogFile=" << folder << "/%n.log\n"
       << "ProctrackType=proctrack/linuxproc\nTaskPlugin=task/none\nMpiDefault=none\n"
       << "JobAcctGatherType=jobacct_gather/none\nAccountingStorageType=accounting_storage/none\n"
       << "SelectType=select/linear\nSchedulerType=sched/builtin\nReturnToService=2\nKillWait=1\n"
       // A node that is killed must be noticed; a busy one must not be taken for it.
       << "MessageTimeout=60\nSlurmdTimeout=30\n";
  for (int i = 1; i <= nodes; ++i)
    conf << "NodeName=node" << i << " NodeHostname=" << name << " NodeAddr=127.0.0.1 Port=" << kFirstPort + i
         << " CPUs=1 RealMemory=100 State=UNKNOWN\n";
  conf << "PartitionName=render Nodes=ALL Default=YES MaxTime=INFINITE State=UP\n";
}

Cluster::Cluster(const fs::path& folder, int nodes, const std::map<int, std::string>& mounts)
    : folder_(folder) {
  ::setenv("SLURM_CONF", (folder_ / "slurm.conf").c_str(), 1);
  ::setenv("PATH", (std::string(std::getenv("PATH")) + ":/usr/sbin:/sbin").c_str(), 1);
  fs::create_directories(folder_ / "state");
  enter_own_network();
  configure(nodes);

  // The key of this cluster alone.
  const std::string key = (folder_ / "munge.key").string(), socket = (folder_ / "munge.socket").string();
  std::random_device random;
  std::ofstream key_file(key, std::ios::binary);
  for (int i = 0; i < 1024; ++i) key_file.put(static_cast<char>(random()));
  key_file.close();
  fs::permissions(key, fs::perms::owner_read);
  munge_ = start(
      {"munged", "--force", "--foreground", "--socket=" + socket, "--key-file=" + key,
       "--pid-file=" + (folder_ / "munge.pid").string(), "--log-file=" + (folder_ / "munge.log").string(),
       "--seed-file=" + (folder_ / "munge.seed").string(), "--num-threads=2"},
      "munged");
  while (!fs::exists(socket)) std::this_thread::sleep_for(std::chrono::milliseconds(20));

  controller_ = start({"slurmctld", "-D"}, "slurmctld");
  for (int i = 1; i <= nodes; ++i) {
    const std::string name = "node" + std::to_string(i);
    fs::create_directories(folder_ / "spool" / name);
    const std::string mount = mounts.contains(i) ? mounts.at(i) + " && " : "";
    nodes_.push_back(start({"unshare", "--mount", "--pid", "--fork", "--kill-child", "--mount-proc", "sh",
                            "-c", mount + "exec slurmd -D -N " + name},
                           name));
  }
  const std::string idle(static_cast<std::size_t>(nodes), 'i');
  std::string states;
  while (states != idle) {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    states.clear();
    std::istringstream lines(output_of("sinfo --noheader --Node --format=%T 2> /dev/null"));
    for (std::string line; std::getline(lines, line);) states += line == "idle" ? 'i' : '-';
  }
}

Cluster::~Cluster() {
  for (pid_t& node : nodes_) end(node, SIGKILL);
  end(controller_, SIGKILL);
  end(munge_, SIGTERM);
}

void Cluster::kill(int node) {
  end(nodes_[static_cast<std::size_t>(node - 1)], SIGKILL);
}

}  // namespace brume::cli
