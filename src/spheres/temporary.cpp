#include <random>
#include <unordered_map>
#include "spheres/file.hpp"
#include "spheres/pack.hpp"
namespace brume::spheres {
bool is_tank_file(const std::filesystem::path& p) {
  return p.extension() == ".spheres";
}
Result<Tank> load_tank(const std::filesystem::path&) {
  return Failure{ErrorCode::bad_input, "none"};
}
Result<Tank> pack(const PackOptions& o, const std::function<bool()>&) {
  Tank t;
  t.size = o.size;
  t.voxel = o.voxel;
  std::mt19937 rng(1);
  std::uniform_real_distribution<float> u(0, 1);
  const int g = 40;
  std::unordered_map<long, std::vector<int>> cells;
  auto key = [&](glm::ivec3 c) { return (long(c.z) * 1000 + c.y) * 1000 + c.x; };
  for (int tries = 0; tries < 3000000 && t.spheres.size() < o.count; ++tries) {
    float r = tries < 20000 ? o.radius.y * (0.5f + 0.5f * u(rng))
                            : o.radius.x + (o.radius.y * 0.4f - o.radius.x) * u(rng) * u(rng);
    glm::vec3 c = glm::vec3(r) + (glm::vec3(o.size) - 2 * r) * glm::vec3(u(rng), u(rng), u(rng));
    bool ok = true;
    glm::ivec3 cell = glm::ivec3(c / float(g));
    for (int z = -1; z <= 1 && ok; ++z)
      for (int y = -1; y <= 1 && ok; ++y)
        for (int x = -1; x <= 1 && ok; ++x)
          if (auto f = cells.find(key(cell + glm::ivec3(x, y, z))); f != cells.end())
            for (int i : f->second)
              if (glm::distance(t.spheres[i].center, c) < t.spheres[i].radius + r) {
                ok = false;
                break;
              }
    if (!ok) continue;
    cells[key(cell)].push_back(int(t.spheres.size()));
    t.spheres.push_back({c, r});
    float h = u(rng);
    glm::vec3 col = glm::mix(glm::vec3(20, 90, 160), glm::vec3(250, 170, 90), h);
    if (u(rng) < .15f) col = glm::vec3(245, 240, 225);
    t.colors.push_back(std::uint32_t(col.x) | std::uint32_t(col.y) << 8 | std::uint32_t(col.z) << 16 |
                       std::uint32_t(o.opacity * 255 + .5f) << 24);
  }
  return t;
}
}  // namespace brume::spheres
