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

/// What instances are made of, moved by `-center` to where floats are finest.
struct Object {
  struct Member {
    std::string name;
    std::uint32_t material;
    std::shared_ptr<const Prototype> prototype;
  };
  std::vector<Member> parts;
  Imath::V3d center{0, 0, 0};
};

/// A spectrum that lamps name, and what they hold of it.
struct LampSpectrum {
  Curve curve;          ///< As named.
  double power;         ///< Its integral,
  double luminous;      ///< and that of what the eye sees.
  double held_for = 0;  ///< `held` is the curve times this and 2^-`exponent`; 0 while there is none.
  int exponent = 0;
  std::shared_ptr<const Curve> held = nullptr;  ///< In [0, 1], so that no float overflows.
};

/// A table of a lamp or a sensor that does not cover all wavelengths and does not say `clamp`.
struct EndedTable {
  NamedCurve table;
  SourcePosition where;  ///< It is named there,
  std::string channel;   ///< and belongs to this channel of a sensor; to all where there is none.
};

/// How tables are held to what the sensor sees.
struct TableEnds {
  NeededRange needed{};  ///< What they must cover: by the responses of the sensor or meter, once it is built.
  std::span<const Channel> channels{};       ///< That sensor's; none of a meter, which takes what it is told.
  std::vector<EndedTable>* noted = nullptr;  ///< Those of the lamp or sensor that is being built, if wanted,
  std::string channel{};                     ///< and the channel that is.
  bool go_on = false;            ///< Whether lights and filters go on beyond their tables as they end.
  std::set<std::string> told{};  ///< What has been warned of.
};

/// What the readers of one scene file share.
struct LoadContext {
  Diagnostics& diagnostics;
  std::filesystem::path folder;  ///< Of the scene file: where the files it names are looked for.
  Inputs* inputs = nullptr;      ///< Of the command, if it keeps account of them.
  double unit_m = 1;             ///< Metres per unit of length.
  std::vector<std::filesystem::path> files{};  ///< Every file named so far, for the hash.
  std::vector<SourcePosition> emissions{};     ///< Where each light's is told.
  std::vector<SourcePosition> shape_places{};  ///< Where each shape of the scene is described.
  std::map<std::string, Object> objects{};
  std::unordered_map<std::string, LampSpectrum> lamp_spectra{};  ///< By the words that name them.
  std::unordered_map<std::string, std::uint32_t> materials{};    ///< Numbers by name.
  std::vector<std::shared_ptr<Placement>> placements{};  ///< Of each instance, until the scene is recentred,
  std::vector<std::shared_ptr<Motion>> motions{};        ///< and of all that moves.
  double open_s = 0;                                     ///< When the shutter opens,
  double span_s = 1;                                     ///< and how long until it has closed for all rows.
  TableEnds ends{};

  /// A file named by the scene, remembered for the hash; a URL is reported.
  [[nodiscard]] std::optional<std::filesystem::path> file(const std::string& name,
                                                          const SourcePosition& where);
  void remember(const std::filesystem::path& file);
  /// Counts memory that is about to be taken. Throws Error{resource} when it is too much.
  void take_memory(const std::string& what, std::size_t bytes) const;
  /// A table's name as the libraries take it: a user's `FILE.csv`, `FILE.csv:COLUMN` or `FILE.yml` is looked
  /// for beside the scene.
  [[nodiscard]] std::optional<std::string> table(const std::string& name, const SourcePosition& where);
};

}  // namespace abbe::description
