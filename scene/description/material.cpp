#include <algorithm>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "materials/index/library.h"
#include "scene/description/pieces.h"

namespace abbe::description {
namespace {

// Every measured index lies well inside.
constexpr Range kIndex{0, 100, true, false};
constexpr Range kMetalIndex{0, 100};  // n = 0 is the perfect mirror
constexpr Range kExtinction{0, 100};
constexpr char kBlack[] = "black (lamp)";

// k of an absorption coefficient alpha [1/m]: alpha lambda/(4 pi), lambda in metres.
Curve extinction(const Curve& absorption_per_m) {
  const auto k = [](double nm) { return nm * 1e-9 / (4 * std::numbers::pi); };
  const Curve per_alpha(
      std::vector<Knot>{{kMinWavelengthNm, k(kMinWavelengthNm)}, {kMaxWavelengthNm, k(kMaxWavelengthNm)}});
  return product(absorption_per_m, per_alpha);
}

struct Ior {
  std::string name;
  RefractiveIndex index;
  bool constant;
};

std::optional<Ior> constant_ior(double n, double k) {
  return Ior{k > 0 ? fmt::format("{} + {}i", n, k) : fmt::format("{}", n), RefractiveIndex(n, k), true};
}

std::optional<Ior> read_ior(const JsonValue& json, Range allowed, Reading& reading) {
  if (std::holds_alternative<double>(json.value)) {
    const auto n = read_number(json, allowed, reading.diagnostics);
    return n ? constant_ior(*n, 0) : std::nullopt;
  }
  if (std::holds_alternative<JsonValue::Object>(json.value)) {
    ObjectReader reader(json, reading.diagnostics);
    const auto n = reader.require_number("n", allowed);
    const double k = reader.number_or("k", 0, kExtinction);
    reader.finish();
    return n ? constant_ior(*n, k) : std::nullopt;
  }
  const auto name = reading.table(json);
  if (!name) return std::nullopt;
  auto named = load_index(*name, json.where, reading.diagnostics);
  if (!named) return std::nullopt;
  return Ior{std::move(named->name), std::move(named->index), false};
}

std::optional<DiffuseMaterial> read_diffuse(const JsonValue& json, Reading& reading) {
  ObjectReader reader(json, reading.diagnostics);
  const JsonValue* value = reader.require("reflectance");
  reader.finish();
  if (!value) return std::nullopt;
  auto reflectance = read_curve(*value, {"reflectance", Range::unit()}, reading);
  if (!reflectance) return std::nullopt;
  return DiffuseMaterial{std::move(*reflectance)};
}

constexpr Range kFilmThickness{0, 1e5, true, false};  // [nm]; nothing thicker is coherent
constexpr Range kRepeats{1, static_cast<double>(Coating::kMaxLayers)};

// The number of the matter `json` names among those of `coating`, added if it is new: the same words name the
// same matter.
std::optional<std::uint32_t> film_matter(const JsonValue& json, Coating& coating, Reading& reading) {
  auto ior = read_ior(json, kIndex, reading);
  if (!ior) return std::nullopt;
  const auto* words = std::get_if<std::string>(&json.value);
  const std::string name = words ? *words : ior->name;
  const auto known = std::find_if(coating.matters.begin(), coating.matters.end(),
                                  [&](const Coating::Matter& matter) { return matter.index_name == name; });
  const auto number = static_cast<std::uint32_t>(known - coating.matters.begin());
  if (known != coating.matters.end()) return number;
  if (number == Coating::kMaxMatters) {
    reading.diagnostics.error(
        json.where, fmt::format("too many materials in a coating (allowed {})", Coating::kMaxMatters));
    return std::nullopt;
  }
  coating.matters.push_back({name, std::move(ior->index)});
  return number;
}

// Layers and repeated groups of them, from the outside inwards.
void read_layers(const JsonValue& json, Coating& coating, Reading& reading) {
  const JsonValue::Array* entries = read_array(json, "layers", 1, reading);
  if (!entries) return;
  for (const JsonValue& entry : *entries) {
    ObjectReader reader(entry, reading.diagnostics);
    const std::size_t first = coating.layers.size();
    std::int64_t repeats = 1;
    if (const JsonValue* group = reader.find("layers")) {
      repeats = reader.integer("repeat", kRepeats).value_or(1);
      read_layers(*group, coating, reading);
    } else {
      const JsonValue* ior = reader.require("ior");
      const auto thickness = reader.require_number("thickness_nm", kFilmThickness);
      const auto matter = ior ? film_matter(*ior, coating, reading) : std::nullopt;
      if (matter && thickness) coating.layers.push_back({*matter, *thickness});
    }
    reader.finish();
    const std::size_t last = coating.layers.size();
    if (first + (last - first) * static_cast<std::size_t>(repeats) > Coating::kMaxLayers) {
      reading.diagnostics.error(entry.where,
                                fmt::format("too many layers (allowed {})", Coating::kMaxLayers));
      return;
    }
    for (; repeats > 1; --repeats)
      for (std::size_t i = first; i < last; ++i) coating.layers.push_back(coating.layers[i]);
  }
}

// The layers under a key, if it is there.
Coating read_coating(const JsonValue* layers, Reading& reading) {
  Coating coating;
  if (layers) read_layers(*layers, coating, reading);
  return coating;
}

std::optional<DielectricMaterial> read_dielectric(const JsonValue& json, Reading& reading) {
  ObjectReader reader(json, reading.diagnostics);
  const JsonValue* value = reader.require("ior");
  const JsonValue* absorption = reader.find("absorption_per_m");
  Coating coating = read_coating(reader.find("coating"), reading);
  reader.finish();
  if (!value) return std::nullopt;
  auto ior = read_ior(*value, kIndex, reading);
  if (!ior) return std::nullopt;
  if (!absorption) return DielectricMaterial{std::move(ior->name), std::move(ior->index), std::move(coating)};
  if (!ior->constant || ior->index.absorbing()) {
    reading.diagnostics.error(absorption->where,
                              "absorption_per_m goes with a constant real index; this one brings its own k");
    return std::nullopt;
  }
  const auto alpha = read_curve(*absorption, {"filter", kPower}, reading);
  if (!alpha) return std::nullopt;
  return DielectricMaterial{
      std::move(ior->name),
      RefractiveIndex(Curve(ior->index.catalogued_n(kMinWavelengthNm)), extinction(*alpha), IndexMedium::air,
                      kMinWavelengthNm, kMaxWavelengthNm),
      std::move(coating)};
}

std::optional<ConductorMaterial> read_conductor(const JsonValue& json, Reading& reading) {
  ObjectReader reader(json, reading.diagnostics);
  const JsonValue* value = reader.require("ior");
  Coating coating = read_coating(reader.find("coating"), reading);
  reader.finish();
  if (!value) return std::nullopt;
  auto ior = read_ior(*value, kMetalIndex, reading);
  if (!ior) return std::nullopt;
  return ConductorMaterial{std::move(ior->name), std::move(ior->index), std::move(coating)};
}

// A film with air on both sides, such as a soap bubble's: a coating on nothing.
std::optional<DielectricMaterial> read_film(const JsonValue& json, Reading& reading) {
  ObjectReader reader(json, reading.diagnostics);
  Coating coating = read_coating(reader.require("layers"), reading);
  reader.finish();
  return DielectricMaterial{"air", RefractiveIndex(1), std::move(coating)};
}

// A material that cannot be read stands as black, so that the shapes naming it are not reported as well.
Material read_material(const std::string& name, const JsonValue& json, Reading& reading) {
  Material material{name, DiffuseMaterial{Curve(0.0)}};
  ObjectReader reader(json, reading.diagnostics);
  const auto key = reader.exactly_one({"diffuse", "dielectric", "conductor", "film"});
  if (!key) return material;
  const JsonValue& model = *reader.find(*key);
  if (*key == "diffuse") {
    if (auto diffuse = read_diffuse(model, reading)) material.model = std::move(*diffuse);
  } else if (*key == "dielectric") {
    if (auto dielectric = read_dielectric(model, reading)) material.model = std::move(*dielectric);
  } else if (*key == "film") {
    if (auto film = read_film(model, reading)) material.model = std::move(*film);
  } else if (auto conductor = read_conductor(model, reading)) {
    material.model = std::move(*conductor);
  }
  reader.finish();
  return material;
}

// Where a curve differs from zero: [low, high] nm, empty when it never does.
struct Support {
  double low = kMaxWavelengthNm;
  double high = kMinWavelengthNm;
};
void extend(Support& support, const Curve& curve) {
  const auto knots = curve.knots();
  if (curve.is_constant() && curve.max() != 0) support = {kMinWavelengthNm, kMaxWavelengthNm};
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    if (knots[i].value == 0 && knots[i + 1].value == 0) continue;
    support.low = std::min(support.low, knots[i].wavelength_nm);
    support.high = std::max(support.high, knots[i + 1].wavelength_nm);
  }
}

}  // namespace

void read_materials(const JsonValue& json, Reading& reading, Scene& scene) {
  const auto* members = std::get_if<JsonValue::Object>(&json.value);
  if (!members) {
    reading.diagnostics.error(json.where,
                              fmt::format("expected an object of materials by name (got {})", json.kind()));
    return;
  }
  for (const auto& [name, value] : *members) {
    reading.materials.emplace(name, static_cast<std::uint32_t>(scene.materials.size()));
    scene.materials.push_back(read_material(name, value, reading));
  }
}

std::optional<std::uint32_t> find_material(const JsonValue& json, Reading& reading, const Scene& scene) {
  const std::optional<std::string> name = read_string(json, reading.diagnostics);
  if (!name) return std::nullopt;
  if (const auto found = reading.materials.find(*name); found != reading.materials.end())
    return found->second;
  std::vector<std::string> names;
  for (const Material& material : scene.materials) names.push_back(material.name);
  reading.diagnostics.error(json.where, unknown_name("material", *name, names));
  return std::nullopt;
}

std::uint32_t add_file_material(const FileMaterial& material, const std::string& file, const JsonValue& at,
                                Reading& reading, Scene& scene) {
  const std::string name = file + ":" + material.name;
  const auto [known, added] =
      reading.materials.emplace(name, static_cast<std::uint32_t>(scene.materials.size()));
  if (!added) return known->second;
  if (material.index)
    scene.materials.push_back(
        {name, DielectricMaterial{fmt::format("{}", *material.index), RefractiveIndex(*material.index, 0)}});
  else
    scene.materials.push_back({name, DiffuseMaterial{rgb_spectrum(material.color)}});
  if (!material.lost.empty())
    reading.diagnostics.warning(
        at.where, fmt::format("material \"{}\" of \"{}\": {} {} not represented", material.name, file,
                              fmt::join(material.lost, ", "), material.lost.size() == 1 ? "is" : "are"));
  return known->second;
}

std::uint32_t black_material(Reading& reading, Scene& scene) {
  const auto [known, added] =
      reading.materials.emplace(kBlack, static_cast<std::uint32_t>(scene.materials.size()));
  if (added) scene.materials.push_back({kBlack, DiffuseMaterial{Curve(0.0)}});
  return known->second;
}

void check_validity(const JsonValue& json, const Reading& reading, const Scene& scene) {
  Support sensor;
  for (const Channel& channel : scene.channels) extend(sensor, channel.weight);
  const auto check = [&](const Material& material, const std::string& name, const RefractiveIndex& index) {
    if (index.low_nm() <= sensor.low && sensor.high <= index.high_nm()) return;
    const JsonValue* at = json.find(material.name);
    reading.diagnostics.warning(
        at ? at->where : json.where,
        fmt::format("{} holds on [{:g}, {:g}] nm, the sensor sees [{:g}, {:g}] nm: outside, the index is "
                    "held from the nearer end",
                    name, index.low_nm(), index.high_nm(), sensor.low, sensor.high));
  };
  const auto check_all = [&](const Material& material, const auto& model) {
    check(material, model.index_name, model.index);
    for (const Coating::Matter& matter : model.coating.matters)
      check(material, matter.index_name, matter.index);
  };
  for (const Material& material : scene.materials) {
    if (const auto* dielectric = std::get_if<DielectricMaterial>(&material.model))
      check_all(material, *dielectric);
    else if (const auto* conductor = std::get_if<ConductorMaterial>(&material.model))
      check_all(material, *conductor);
  }
}

}  // namespace abbe::description
