#include "calibration/output/sensitivities.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "spectral/colorimetry.h"

namespace abbe {

std::string sensitivities_json(const std::string& camera, std::span<const Channel> channels) {
  constexpr int kStep = 5;
  constexpr SumRange kRange = kVisibleRange;  // the range that those programs expect
  double greatest = 0;
  for (const Channel& channel : channels)
    for (int nm = kRange.low_nm; nm <= kRange.high_nm; nm += kStep)
      greatest = std::max(greatest, channel.weight(nm));
  nlohmann::ordered_json file;
  file["header"] = {{"schema_version", "1.0.0"},
                    {"manufacturer", ""},
                    {"model", camera},
                    {"description", "energy responses, the greatest of all being 1"},
                    {"license", ""}};
  auto& data = file["spectral_data"];
  data["units"] = "relative";
  for (const Channel& channel : channels) data["index"]["main"].push_back(channel.name);
  for (int nm = kRange.low_nm; nm <= kRange.high_nm; nm += kStep)
    for (const Channel& channel : channels)
      data["data"]["main"][std::to_string(nm)].push_back(channel.weight(nm) / greatest);
  return file.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace abbe
