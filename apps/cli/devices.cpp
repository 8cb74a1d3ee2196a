
#include "apps/cli/command.hpp"
#include "apps/command_line/console.hpp"
#include "apps/command_line/json.hpp"
#include "core/utf8.hpp"
#include "gpu/device_list.hpp"

namespace brume::cli {
namespace {

std::string version_text(std::uint32_t version) {
  // The layout of VK_MAKE_API_VERSION.
  return std::to_string(version >> 22 & 0x7f) + "." + std::to_string(version >> 12 & 0x3ff) + "." +
         std::to_string(version & 0xfff);
}

void list_devices(const std::string& json) {
  Json devices = Json::list({});
  std::string text;
  int number = 0;
  for (const gpu::DeviceInfo& device : gpu::list_system_devices()) {
    devices.push_back({{"number", number},
                       {"name", device.name},
                       {"kind", gpu::name_of(device.kind)},
                       {"driver", device.driver},
                       {"vulkan", version_text(device.api_version)},
                       {"memory_bytes", device.memory_bytes},
                       {"unsupported", device.unsupported}});
    text += std::to_string(number) + "  " + device.name + "  (" + gpu::name_of(device.kind) + ", " +
            device.driver + ", Vulkan " + version_text(device.api_version) + ", " +
            std::to_string(device.memory_bytes >> 20) + " MiB)" +
            (device.unsupported.empty() ? "" : "  unsupported: " + device.unsupported) + "\n";
    ++number;
  }
  if (!json.empty()) write_json(json, {{"devices", devices}});
  if (json != "-") print(text);
}

}  // namespace

Command add_devices(CommandLine& program) {
  Command command =
      declare(program, "devices", "Lists the Vulkan devices and the numbers that --device takes.",
              "  brume devices\n  brume devices --json -");
  auto json = std::make_shared<std::string>();
  declare_json(command.arguments, *json, "the list");
  command.run = [json, common = command.common] {
    common->outputs.writes("--json", to_path(*json), FileKind::json);
    list_devices(*json);
  };
  return command;
}

}  // namespace brume::cli
