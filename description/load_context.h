#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include <ImathVec.h>

#include "io/inputs.h"
#include "io/json.h"
#include "scene/shapes/shape.h"
#include "sensor/response/channel.h"
#include "spectral/curve.h"
#include "spectral/library.h"

namespace abbe::description {

/// Prototypes of an object for its instances. They are shifted by `-center` to the origin, where single
/// precision resolves best.
struct Object {
  struct Member {
    std::string name;
    std::uint32_t material;
    std::shared_ptr<const Prototype> prototype;
  };
  std::vector<Member> parts;
  Imath::V3d center{0, 0, 0};
};

/// A spectrum that one or more lights name.
struct SharedLightSpectrum {
  Curve curve;                  ///< The spectrum before scaling.
  double power;                 ///< Integral of `curve` over wavelength.
  double luminous;              ///< Photometric integral of `curve`.
  double reference_factor = 0;  ///< Scale of the first light; 0 while `normalised` is empty.
  int exponent = 0;
  std::shared_ptr<const Curve> normalised =
      nullptr;  ///< `curve` * reference_factor * 2^-exponent, in [0, 1].
};

/// A table of a light or a sensor that does not cover all wavelengths and does not declare `clamp`.
struct PartialTable {
  NamedCurve table;
  SourcePosition where;  ///< Position at which the scene names the table.
  std::string channel;   ///< Channel of a sensor to which it belongs; empty for all channels.
};

/// Rules by which tables must cover the wavelength range of the sensor.
struct TableCoverage {
  NeededRange needed{};                 ///< Range that tables must cover, once sensor or meter is built.
  std::span<const Channel> channels{};  ///< Channels of the sensor; empty for a meter.
  std::vector<PartialTable>* partial_tables =
      nullptr;            ///< If set, collects the partial tables of the light or sensor under construction.
  std::string channel{};  ///< Name of the channel under construction.
  bool extrapolate = false;        ///< True to extrapolate lights and filters with their end values.
  std::set<std::string> warned{};  ///< Warnings that have been reported.
};

/// State that the builders of one scene have in common.
struct LoadContext {
  Diagnostics& diagnostics;
  std::filesystem::path folder;  ///< Folder to which the files that the scene names are relative.
  Inputs* inputs = nullptr;      ///< Record of input files and memory, if the command has one.
  double unit_m = 1;             ///< Metres per scene unit.
  std::vector<std::filesystem::path> files{};        ///< Every file named so far, for the hash of the scene.
  std::vector<SourcePosition> emission_positions{};  ///< Position of each light's emission in the scene file.
  std::vector<SourcePosition> shape_positions{};  ///< Position of each shape of the scene in the scene file.
  std::map<std::string, Object> objects{};
  std::unordered_map<std::string, SharedLightSpectrum>
      light_spectra{};                                         ///< Light spectra by unit, scaling and text.
  std::unordered_map<std::string, std::uint32_t> materials{};  ///< Index in `Scene::materials` by name.
  std::vector<std::shared_ptr<Placement>>
      placements{};                                ///< Placement of each instance; recentred with the scene.
  std::vector<std::shared_ptr<Motion>> motions{};  ///< Every motion; recentred with the scene.
  double open_s = 0;                               ///< Time at which the first row opens [s].
  double span_s = 1;                               ///< Time from then until all rows are closed [s].
  TableCoverage coverage{};

  /// Path of a file that the scene names, recorded for the hash. Reports a URL and returns nothing.
  [[nodiscard]] std::optional<std::filesystem::path> file(const std::string& name,
                                                          const SourcePosition& where);
  /// Records a file for the hash and in `inputs`.
  void remember(const std::filesystem::path& file);
  /// Adds to the memory of the inputs before it is allocated. Throws Error{resource} if the limit is
  /// exceeded.
  void take_memory(const std::string& what, std::size_t bytes) const;
  /// Name of a table as the data libraries accept it. A user's `FILE.csv`, `FILE.csv:COLUMN` or `FILE.yml`
  /// becomes a path relative to the scene. Reports a URL and returns nothing.
  [[nodiscard]] std::optional<std::string> table(const std::string& name, const SourcePosition& where);
};

}  // namespace abbe::description
