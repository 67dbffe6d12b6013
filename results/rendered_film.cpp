#include "results/rendered_film.h"

#include <link.h>

#include <algorithm>
#include <cstring>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "develop/radiance.h"
#include "io/data_directory.h"
#include "io/error.h"
#include "io/exr.h"
#include "io/text.h"
#include "results/spectral.h"
#include "results/white.h"
#include "scene/white.h"
#include "sensor/film/film_planes.h"
#include "sensor/film/recorded_attributes.h"
#include "sensor/readout/demosaic.h"
#include "sensor/readout/speed.h"
#include "sensor/response/polarised_channels.h"
#include "transport/plan/techniques.h"
#include "transport/render/white.h"

namespace abbe {
namespace {

constexpr std::size_t kMaxShapes = 1024;

// Records the features, and the names of the shapes that ids refer to.
void add_features(const Scene& scene, const std::vector<Feature>& features, FilmIdentity& identity) {
  identity[kFeaturesKey] = to_text(features);
  const bool ids = std::ranges::find(features, Feature::id) != features.end();
  if (!ids || scene.shapes.size() > kMaxShapes) return;
  using Json = nlohmann::ordered_json;
  Json names = Json::array();
  for (const ShapeInstance& shape : scene.shapes) names.push_back(shape.name);
  // Material names of mesh files may contain any bytes.
  identity[kShapeNamesKey] = names.dump(-1, ' ', false, Json::error_handler_t::replace);
}

// Standard attributes of EXR files are in single precision.
std::string single(double x) {
  return fmt::format("{}", static_cast<float>(x));
}

// The sensor's exposure time if a channel has it, else that of all channels. Empty if channels have different
// ones, as behind a filter wheel.
std::optional<double> standard_exposure(const Scene& scene) {
  const auto count = [&scene](double ratio) {
    return std::ranges::count(scene.channels, ratio, &Channel::exposure_ratio);
  };
  if (count(1) > 0) return scene.exposure_s;
  const double ratio = scene.channels.front().exposure_ratio;
  if (count(ratio) == std::ssize(scene.channels)) return scene.exposure_s * ratio;
  return std::nullopt;
}

void add_speed(const Scene& scene, double area_m2, FilmIdentity& identity) {
  const auto sensitivity = daylight_sensitivity(scene.channels, area_m2);
  if (!sensitivity) return;
  identity["electrons_per_lx_s"] = fmt::format("{}", *sensitivity);
  if (scene.readout) identity[kIsoSpeedKey] = single(saturation_speed(*scene.readout, *sensitivity));
}

// Records how pictures show the film, or why none can. A missing data table is not a property of the film.
void add_display(const Scene& scene, FilmIdentity& identity) {
  try {
    identity["to_xyz_d65"] = to_text(display_of(scene).to_xyz_d65());
  } catch (const Error& error) {
    if (error.code == ErrorCode::internal) throw;
    if (error.code == ErrorCode::usage) identity[kNoPictureKey] = error.what();
  }
}

void add_layer(Image& film, const std::string& name, Image layer) {
  const std::string variance = variance_of("");
  for (ImageChannel& channel : layer.channels) {
    const bool is_variance = channel.name.starts_with(variance);
    const std::string plane = is_variance ? channel.name.substr(variance.size()) : channel.name;
    const std::string of_layer = name + "." + plane;
    film.channels.push_back({is_variance ? variance_of(of_layer) : of_layer, std::move(channel.values)});
  }
}

const char* unit_of(ResponseKind kind) {
  switch (kind) {
    case ResponseKind::energy:
      return "energy, response-weighted J per m^2";
    case ResponseKind::quantum:
      return "quantum, electrons per m^2";
    case ResponseKind::photometric:
      return photometric_unit(Observer::cie1931);
    case ResponseKind::photometric_1964:
      return photometric_unit(Observer::cie1964);
  }
  throw Error(ErrorCode::internal, "", "unknown response kind");
}

std::size_t padded(std::size_t bytes) {
  return (bytes + 3) / 4 * 4;
}

// Description of the note NT_GNU_BUILD_ID; empty if there is none.
std::string_view build_id_among(std::string_view notes) {
  constexpr std::string_view kOwner("GNU\0", 4);
  while (notes.size() > sizeof(ElfW(Nhdr))) {
    ElfW(Nhdr) note;
    std::memcpy(&note, notes.data(), sizeof(note));
    const std::size_t name = sizeof(note);
    const std::size_t description = name + padded(note.n_namesz);
    const std::size_t end = description + padded(note.n_descsz);
    if (end > notes.size()) break;
    if (note.n_type == NT_GNU_BUILD_ID && notes.substr(name, note.n_namesz) == kOwner)
      return notes.substr(description, note.n_descsz);
    notes.remove_prefix(end);
  }
  return {};
}

// True if this code is in the object: in the program itself, or in a module of another program.
bool is_ours(const dl_phdr_info& object) {
  const auto here = reinterpret_cast<ElfW(Addr)>(&padded);
  for (int i = 0; i < object.dlpi_phnum; ++i) {
    const ElfW(Phdr)& segment = object.dlpi_phdr[i];
    const ElfW(Addr) begin = object.dlpi_addr + segment.p_vaddr;
    if (segment.p_type == PT_LOAD && here >= begin && here < begin + segment.p_memsz) return true;
  }
  return false;
}

// True if the object's code computes film values.
bool decides_bits(const dl_phdr_info& object) {
  const std::string_view path = object.dlpi_name;
  const std::string_view name = path.substr(path.rfind('/') + 1);
  return is_ours(object) || name.starts_with("libembree") || name.starts_with("libm.so");
}

// Appends the object's build id to the string `ids`, as a callback of dl_iterate_phdr.
int add_build_id(dl_phdr_info* object, std::size_t, void* ids) {
  if (!decides_bits(*object)) return 0;
  for (int i = 0; i < object->dlpi_phnum; ++i) {
    const ElfW(Phdr)& segment = object->dlpi_phdr[i];
    if (segment.p_type != PT_NOTE || segment.p_align > 4) continue;
    // The loader has mapped the notes to this address. NOLINTNEXTLINE(performance-no-int-to-ptr)
    const auto* notes = reinterpret_cast<const char*>(object->dlpi_addr + segment.p_vaddr);
    *static_cast<std::string*>(ids) += build_id_among({notes, segment.p_memsz});
  }
  return 0;
}

// SHA-256, in hexadecimal, of the build ids of all machine code that computes film values: this program,
// Embree and the C mathematics library. Films of one scene have the same bits if it and `instruction_set`
// are equal. Code without a build id does not contribute.
std::string build_id() {
  std::string ids;
  ::dl_iterate_phdr(add_build_id, &ids);
  return sha256(ids);
}

// The instruction set that the processor supports: "x86-64-v4" with AVX-512, else "x86-64-v3". Libraries may
// select their code by it, so films have the same bits only if it is equal.
std::string instruction_set() {
  const bool v4 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                  __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                  __builtin_cpu_supports("avx512vl");
  return v4 ? "x86-64-v4" : "x86-64-v3";
}

}  // namespace

FilmIdentity identity_of(const Scene& scene, const std::filesystem::path& scene_file,
                         const RenderOptions& options) {
  std::string name = scene_file.filename().string();
  std::replace(name.begin(), name.end(), '\n', '?');  // metadata have one line per entry
  FilmIdentity identity{
      {"version", ABBE_VERSION},
      {kBuildKey, build_id()},
      {kInstructionSetKey, instruction_set()},
      {"scene", name},
      {"scene_sha256", scene.sha256},
      {"data_sha256", data_sha256()},
      {"seed", fmt::format("{}", scene.render.seed)},
      {"integrator", integrator_name(scene.render.integrator)},
      {"replicates", fmt::format("{}", replicate_count(scene, options))},
  };
  const std::string_view bias = bias_of(chosen_techniques(scene).front());
  if (!bias.empty()) identity["bias"] = bias;
  identity.merge(film_attributes(scene));
  if (!options.time_limit_s && !options.target_error)
    identity[kStatedSamplesKey] = fmt::format("{}", scene.render.samples);
  if (options.crop && *options.crop != Crop{0, 0, scene.camera.width, scene.camera.height})
    identity[kCropKey] = to_text(*options.crop);
  if (options.layers) identity[kLayersKey] = fmt::format("{}", fmt::join(options.layers->names, ","));
  if (!options.features.empty()) add_features(scene, options.features, identity);
  return identity;
}

std::size_t film_bytes(const Scene& scene, const RenderOptions& options) {
  const FilmShape shape{.width = scene.camera.width,
                        .height = scene.camera.height,
                        .channels = static_cast<int>(scene.film_planes().size()),
                        .replicates = replicate_count(scene, options),
                        .unit_exponent = 0,
                        .crop = options.crop};
  return bytes_of_sums(shape) +
         (options.layers ? bytes_of_sums(layered(shape, options.layers->names.size())) : 0) +
         bytes_of_features(options.features, shape, scene.film_planes());
}

void write_film(const std::filesystem::path& path, const RenderPart& part) {
  if (extension_of(path) == kPartExtension)
    write_part(path, part.identity, part.result, part.areas);
  else
    write_exr(path, film_image(part));
}

FilmIdentity film_attributes(const Scene& scene) {
  const double area_m2 = gathering_area(scene.camera.pixel_pitch, scene.fill_factor);
  FilmIdentity identity{{"sensor", scene.sensor_text},
                        {"exposure_s", fmt::format("{}", scene.exposure_s)},
                        {"gathering_area_m2", fmt::format("{}", area_m2)}};
  if (const auto seconds = standard_exposure(scene)) identity["expTime"] = single(*seconds);
  if (const auto n = traits(scene.camera).f_number) identity["aperture"] = single(*n);
  const std::vector<std::string> names = scene.channel_names();
  for (const Channel& channel : scene.channels) {
    if (channel.exposure_ratio != 1)
      identity["exposure_s." + channel.name] = fmt::format("{}", scene.exposure_s * channel.exposure_ratio);
    identity["channel." + channel.name] = unit_of(channel.kind);
  }
  const auto rows = polariser_rows(scene.channels);
  for (std::size_t k = 0; k < rows.size(); ++k)
    if (rows[k]) identity[kAnalyserKey + names[k]] = to_text(*rows[k]);
  if (count_intensities(scene.channels) < scene.channels.size()) identity[kHandednessKey] = kRightHanded;
  identity["sensor_channels"] = fmt::format("{}", fmt::join(scene.film_planes(), ","));
  if (scene.mosaic) {
    identity["mosaic"] = to_text(*scene.mosaic, names);
    identity["mosaic_channels"] = fmt::format("{}", fmt::join(names, ","));
  }
  add_speed(scene, area_m2, identity);
  add_display(scene, identity);
  if (const auto field = white_field(scene)) identity[kWhiteFieldKey] = to_text(*field);
  add_white(scene, identity);
  if (const auto exposure = scene.output.display_exposure)
    identity[kDisplayExposureKey] = fmt::format("{}", *exposure);
  if (scene.spectral) add_spectral_identity(scene, identity);
  return identity;
}

DisplayTransform display_of(const Scene& scene, const ViewOptions& view) {
  if (scene.spectral) return display_of_radiance(view, white_of(scene).xy);
  const White white = has_colors(scene) ? white_of(scene) : White{"", "", {}, Curve(1.0)};
  const std::vector<Channel> channels = intensities(channels_at_center(scene));
  std::vector<std::string> names;
  for (const Channel& channel : channels) names.push_back(channel.name);
  if (const auto calibrated = camera_matrix(view, names, white.name, white.xy))
    return {std::move(names), calibrated->to_xyz_d65, view};
  return make_display(channels, *white.spectrum, view, white.xy);
}

Image film_image(Image planes) {
  if (planes.metadata.contains(kSpectralBinsKey)) return spectral_film_image(planes);
  return planes;
}

Image film_image(const RenderPart& part) {
  Image image = film_image(image_of(part));
  for (auto& [name, layer] : layer_images(part)) add_layer(image, name, film_image(std::move(layer)));
  add_features(image, part);
  return image;
}

Image film_for_display(const Scene& scene, Image film) {
  erase_layer_and_feature_attributes(film.metadata);
  if (scene.mosaic) return demosaic(film, kRawPlane, *scene.mosaic, scene.channel_names());
  return film;
}

}  // namespace abbe
