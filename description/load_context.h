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
#include "spectral/curve_use.h"
#include "spectral/library.h"

namespace abbe::description {

/// Prototypes of an object for its instances. They are shifted by `-center` to the origin, where single
/// precision resolves best.
struct Object {
  /// One part of one of its shapes.
  struct Member {
    std::string name;        ///< Name of the shape, with "/MATERIAL" if a mesh file has several materials.
    std::uint32_t material;  ///< Index in `Scene::materials`.
    std::shared_ptr<const Prototype> prototype;
  };
  std::vector<Member> parts;
  Imath::V3d center{0, 0, 0};  ///< Center of the bounding box in the coordinates of the scene file [m].
};

/// A spectrum that one or more lights name.
struct SharedLightSpectrum {
  Curve curve;                  ///< The spectrum before scaling.
  double power;                 ///< Integral of `curve` over wavelength [nm].
  double luminous;              ///< Photometric integral of `curve`, as in lm for W/nm.
  double reference_factor = 0;  ///< Scale of the first light; 0 while `normalised` is empty.
  int exponent = 0;             ///< Power of two that scales the curve to [0, 1].
  std::shared_ptr<const Curve> normalised =
      nullptr;  ///< `curve` * reference_factor * 2^-exponent, in [0, 1].
};

/// A table of a light or a sensor that does not cover all wavelengths and does not declare `clamp`.
struct PartialTable {
  NamedCurve table;
  SourcePosition where;  ///< Position at which the scene names the table.
  std::string channel;  ///< Channel of a sensor to which it belongs; empty for all channels, and for a light.
};

/// Rules by which tables must cover the wavelength range of the sensor.
struct TableCoverage {
  NeededRange needed{};  ///< Range [nm] that tables must cover, set once sensor or meter is built.
  std::span<const Channel> channels{};  ///< Channels of the sensor; empty for a meter.
  std::vector<PartialTable>* partial_tables =
      nullptr;            ///< If set, collects the partial tables of the light or sensor under construction.
  std::string channel{};  ///< Name of the channel under construction.
  bool extrapolate = false;        ///< True to extrapolate lights and filters with their end values.
  std::set<std::string> warned{};  ///< Warnings that have been reported.
};

/// State that the builders of one scene have in common. One instance per scene that is built; not
/// thread-safe.
struct LoadContext {
  Diagnostics& diagnostics;      ///< Receives all errors and warnings.
  std::filesystem::path folder;  ///< Folder to which the files that the scene names are relative.
  Inputs* inputs = nullptr;  ///< Record of input files and memory; nullptr if there is none, and no limit.
  double unit_m = 1;         ///< Metres per scene unit.
  std::vector<std::filesystem::path> files{};        ///< Every file named so far, for the hash of the scene.
  std::vector<SourcePosition> emission_positions{};  ///< Position of each light's emission in the scene file.
  std::vector<SourcePosition> shape_positions{};  ///< Position of each shape of the scene in the scene file.
  std::map<std::string, Object> objects{};        ///< Objects by name, for instances.
  std::unordered_map<std::string, SharedLightSpectrum>
      light_spectra{};                                         ///< Light spectra by unit, scaling and text.
  std::unordered_map<std::string, std::uint32_t> materials{};  ///< Index in `Scene::materials` by name.
  std::vector<std::shared_ptr<Placement>>
      placements{};                                ///< Placement of each instance; recentred with the scene.
  std::vector<std::shared_ptr<Motion>> motions{};  ///< Every motion; recentred with the scene.
  double open_s = 0;  ///< Time at which the first row opens [s], on the keyframes' clock.
  double span_s = 1;  ///< Duration from then until all rows are closed [s].
  TableCoverage coverage{};

  /// Calls `Diagnostics::refuse`.
  std::nullopt_t refuse(const SourcePosition& where, std::string message,
                        ErrorCode code = ErrorCode::scene) const {
    return diagnostics.refuse(where, std::move(message), code);
  }
  /// Path of a file that the scene names, relative to `folder`; recorded as by `remember`. The file need not
  /// exist. Reports a URL at `where` and returns nothing.
  [[nodiscard]] std::optional<std::filesystem::path> file(const std::string& name,
                                                          const SourcePosition& where);
  /// Records a file for the hash and in `inputs`.
  void remember(const std::filesystem::path& file);
  /// Reserves `bytes` of memory in `inputs` before `what`, a noun for messages, is allocated. Throws
  /// Error{resource} if the limit is exceeded.
  void take_memory(const std::string& what, std::size_t bytes) const;
  /// Name of a table as the data libraries accept it. A user's `FILE.csv`, `FILE.csv:COLUMN`, `FILE.json` or
  /// `FILE.yml` becomes a path below `folder`, recorded as by `remember`; any other name is returned
  /// unchanged. Reports a URL of such a file at `where` and returns nothing.
  [[nodiscard]] std::optional<std::string> table(const std::string& name, const SourcePosition& where);
};

/// Names of the `.json` files of a folder of `data/`, without extension and sorted; empty if there is no such
/// folder. Throws Error{input} if the folder of the shipped tables does not exist.
[[nodiscard]] std::vector<std::string> shipped_names(const char* folder);

/// Adds a partial table to `coverage.partial_tables`, if that is set, with its position `where`. Returns it
/// extrapolated with its end values if `coverage.extrapolate`; other tables unchanged. A table is partial if
/// it ends within 300 to 1100 nm and declares an error outside, or 0 and `use.extrapolates_constant`.
[[nodiscard]] NamedCurve with_extrapolation(NamedCurve table, const CurveUse& use,
                                            const SourcePosition& where, TableCoverage& coverage);

/// A context to build a light or sensor again, in which `with_extrapolation` extrapolates partial tables. Its
/// diagnostics go to `discarded`, because the first build has reported them. It has only the folder and the
/// unit of length of `context`: it records no files and counts no memory.
[[nodiscard]] LoadContext extrapolating_context(const LoadContext& context, Diagnostics& discarded);

/// Reports each partial table that ends where a channel would record more than a negligible fraction of its
/// total for the spectrum `light`: a warning if the table declares 0, else an error. A table of one channel
/// is checked for that channel only. Tables of a light must be extrapolated in `light`, those of a sensor in
/// the weights of `channels`; see `extrapolating_context`. Diagnostics go to `context.diagnostics`, each
/// warning once, even if several lights use the table.
void check_table_range(std::span<const PartialTable> tables, const Curve& light,
                       std::span<const Channel> channels, LoadContext& context);

}  // namespace abbe::description
