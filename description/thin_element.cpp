#include <utility>
#include <vector>

#include "description/material.h"
#include "sampling/angle.h"

// Thin sheets that change the polarisation of light.
namespace abbe::spec {
namespace {

using namespace schema;

template <typename Element>
Field transmittance(std::string_view text) {
  std::optional<Curve> Element::*member = &ThinElement::transmittance;
  return field("transmittance", member, text);
}

}  // namespace

Fields fields(Tag<Polariser>) {
  return describe(
      "polariser", "A linear polariser as one surface, which light crosses without being bent.",
      {transmittance<Polariser>("Transmittance of light polarised along the axis, in [0, 1]; 1 when absent."),
       field("extinction_ratio", &Polariser::extinction_ratio,
             "That transmittance over the one across the axis, 1 or more; nothing passes across it when "
             "absent."),
       defaulted("angle_deg", &Polariser::angle_deg, kAngle,
                 "Angle of its axis to u, counterclockwise as seen from outside.")});
}
static Fields fields(Tag<Retardance>) {
  return describe("retardance", "The same retardance at all wavelengths.",
                  {field("retardance_deg", &Retardance::retardance_deg, kAngle,
                         "By how much fields across the fast axis lag behind, at all wavelengths.")});
}
static Fields fields(Tag<Crystal>) {
  return describe(
      "crystal", "A plate of birefringent matter.",
      {field("birefringence", &Crystal::birefringence,
             "Index along the slow axis less that along the fast one, relative to air, in [0, 10]."),
       field("thickness", &Crystal::thickness, kLength, "Length of its thickness.")});
}
Fields fields(Tag<WavePlate>) {
  return describe(
      "wave_plate", "A wave plate as one surface, which light crosses without being bent.",
      {transmittance<WavePlate>("Transmittance, in [0, 1]; 1 when absent."),
       one_of(&WavePlate::kind, beside<Retardance>("retardance_deg"), beside<Crystal>("birefringence")),
       defaulted("angle_deg", &WavePlate::angle_deg, kAngle,
                 "Angle of its fast axis to u, counterclockwise as seen from outside.")});
}
Fields fields(Tag<Depolariser>) {
  return describe("depolariser", "A surface that lets light straight on and takes its polarisation.",
                  {transmittance<Depolariser>("Transmittance, in [0, 1]; 1 when absent.")});
}

}  // namespace abbe::spec

namespace abbe::description {
namespace {

constexpr Range kRatio{1, 1e30};
constexpr Range kBirefringence{0, 10};

// One over a curve, every nanometre.
Curve reciprocal(const Curve& curve) {
  if (curve.is_constant()) return Curve(1 / curve.max());
  std::vector<Knot> knots;
  for (int nm = kMinWavelengthNm; nm <= kMaxWavelengthNm; ++nm)
    knots.push_back({static_cast<double>(nm), 1 / curve(nm)});
  return Curve(std::move(knots));
}

std::optional<Curve> transmittance(const spec::ThinElement& said, LoadContext& context) {
  if (!said.transmittance) return Curve(1.0);
  return build(*said.transmittance, {"filter", Range::unit(), CurveUnit::share}, context);
}

// How a wave plate retards.
struct Retarding {
  using Kind = decltype(WavePlateMaterial::kind);
  LoadContext& context;

  std::optional<Kind> operator()(std::monostate) const { return std::nullopt; }
  std::optional<Kind> operator()(const spec::Retardance& said) const {
    return WavePlateMaterial::Ideal{said.retardance_deg * kDegree};
  }
  std::optional<Kind> operator()(const spec::Crystal& said) const {
    auto birefringence = build(said.birefringence, {"filter", kBirefringence}, context);
    if (!birefringence) return std::nullopt;
    return WavePlateMaterial::Crystal{said.thickness * context.unit_m, std::move(*birefringence)};
  }
};

}  // namespace

std::optional<MaterialModel> build(const spec::Polariser& said, LoadContext& context) {
  auto passed = transmittance(said, context);
  std::optional<Curve> blocked(0.0);
  if (said.extinction_ratio) {
    blocked = build(*said.extinction_ratio, {"filter", kRatio}, context);
    if (blocked) blocked = reciprocal(*blocked);
  }
  if (!passed || !blocked) return std::nullopt;
  return PolariserMaterial{{std::move(*passed)}, std::move(*blocked), said.angle_deg * kDegree};
}

std::optional<MaterialModel> build(const spec::WavePlate& said, LoadContext& context) {
  auto passed = transmittance(said, context);
  auto kind = std::visit(Retarding{context}, said.kind);
  if (!passed || !kind) return std::nullopt;
  return WavePlateMaterial{{std::move(*passed)}, std::move(*kind), said.angle_deg * kDegree};
}

std::optional<MaterialModel> build(const spec::Depolariser& said, LoadContext& context) {
  auto passed = transmittance(said, context);
  if (!passed) return std::nullopt;
  return DepolariserMaterial{{std::move(*passed)}};
}

}  // namespace abbe::description
