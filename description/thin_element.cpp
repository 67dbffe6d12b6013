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
      "polariser", "A linear polariser modelled as one surface, which light crosses without deflection.",
      {transmittance<Polariser>("Transmittance of light polarised along the axis, in [0, 1]; 1 if absent."),
       field("extinction_ratio", &Polariser::extinction_ratio,
             "Transmittance along the axis over that across it, 1 or more; infinite if absent."),
       defaulted("angle_deg", &Polariser::angle_deg, kAngle,
                 "Angle of its axis to u, counter-clockwise as seen from outside.")});
}
static Fields fields(Tag<Retardance>) {
  return describe("retardance", "The same retardance at all wavelengths.",
                  {field("retardance_deg", &Retardance::retardance_deg, kAngle,
                         "Phase lag of the field across the fast axis, at all wavelengths.")});
}
static Fields fields(Tag<Crystal>) {
  return describe("crystal", "A plate of a birefringent crystal.",
                  {field("birefringence", &Crystal::birefringence,
                         "Refractive index along the slow axis minus that along the fast axis, relative to "
                         "air, in [0, 10]."),
                   field("thickness", &Crystal::thickness, kLength, "Thickness of the plate.")});
}
Fields fields(Tag<WavePlate>) {
  return describe("wave_plate",
                  "A wave plate modelled as one surface, which light crosses without deflection.",
                  {transmittance<WavePlate>("Transmittance, in [0, 1]; 1 if absent."),
                   one_of(&WavePlate::kind, inlined_by<Retardance>("retardance_deg"),
                          inlined_by<Crystal>("birefringence")),
                   defaulted("angle_deg", &WavePlate::angle_deg, kAngle,
                             "Angle of its fast axis to u, counter-clockwise as seen from outside.")});
}
Fields fields(Tag<Depolariser>) {
  return describe("depolariser", "A surface that transmits light without deflection and depolarises it.",
                  {transmittance<Depolariser>("Transmittance, in [0, 1]; 1 if absent.")});
}

}  // namespace abbe::spec

namespace abbe::description {
namespace {

constexpr Range kRatio{1, 1e30};
constexpr Range kBirefringence{0, 10};

// Reciprocal of a curve, sampled every nanometre.
Curve reciprocal(const Curve& curve) {
  if (curve.is_constant()) return Curve(1 / curve.max());
  std::vector<Knot> knots;
  for (int nm = kMinWavelengthNm; nm <= kMaxWavelengthNm; ++nm)
    knots.push_back({static_cast<double>(nm), 1 / curve(nm)});
  return Curve(std::move(knots));
}

std::optional<Curve> transmittance(const spec::ThinElement& spec, LoadContext& context) {
  if (!spec.transmittance) return Curve(1.0);
  return build(*spec.transmittance, {"filter", Range::unit(), CurveUnit::fraction}, context);
}

// Builds the retardance of a wave plate.
struct WavePlateKindBuilder {
  using Kind = decltype(WavePlateMaterial::kind);
  LoadContext& context;

  std::optional<Kind> operator()(std::monostate) const { return std::nullopt; }
  std::optional<Kind> operator()(const spec::Retardance& spec) const {
    return WavePlateMaterial::Ideal{spec.retardance_deg * kDegree};
  }
  std::optional<Kind> operator()(const spec::Crystal& spec) const {
    auto birefringence = build(spec.birefringence, {"filter", kBirefringence}, context);
    if (!birefringence) return std::nullopt;
    return WavePlateMaterial::Crystal{spec.thickness * context.unit_m, std::move(*birefringence)};
  }
};

}  // namespace

std::optional<MaterialModel> build(const spec::Polariser& spec, LoadContext& context) {
  auto passed = transmittance(spec, context);
  std::optional<Curve> blocked(0.0);
  if (spec.extinction_ratio) {
    blocked = build(*spec.extinction_ratio, {"filter", kRatio}, context);
    if (blocked) blocked = reciprocal(*blocked);
  }
  if (!passed || !blocked) return std::nullopt;
  return PolariserMaterial{{std::move(*passed)}, std::move(*blocked), spec.angle_deg * kDegree};
}

std::optional<MaterialModel> build(const spec::WavePlate& spec, LoadContext& context) {
  auto passed = transmittance(spec, context);
  auto kind = std::visit(WavePlateKindBuilder{context}, spec.kind);
  if (!passed || !kind) return std::nullopt;
  return WavePlateMaterial{{std::move(*passed)}, std::move(*kind), spec.angle_deg * kDegree};
}

std::optional<MaterialModel> build(const spec::Depolariser& spec, LoadContext& context) {
  auto passed = transmittance(spec, context);
  if (!passed) return std::nullopt;
  return DepolariserMaterial{{std::move(*passed)}};
}

}  // namespace abbe::description
