#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace abbe {

/// The integrator that renders the scene.
enum class Integrator {
  automatic,     ///< `path` with photons for caustics, or another one that the render finds to be cheaper.
  path,          ///< Path tracing with next-event estimation [Kajiya1986].
  light,         ///< Light tracing: photons connected to the camera [Arvo1986].
  bdpt,          ///< Bidirectional path tracing [Lafortune1993].
  photon_map,    ///< Photon mapping [Jensen1996]; biased.
  ppm,           ///< Progressive photon mapping [Hachisuka2008]; biased, consistent.
  sppm,          ///< Stochastic progressive photon mapping [Hachisuka2009]; biased, consistent.
  vcm,           ///< Vertex connection and merging [Georgiev2012]; biased, consistent.
  photon_brute,  ///< Photons that enter the camera's opening or hit the probe by chance.
  adjoint_brute  ///< Camera paths of one wavelength each that hit lights by chance.
};

/// Paths that an integrator traces.
enum class TracedPaths : std::uint8_t {
  camera,           ///< Camera paths, connected to lights.
  light,            ///< Light paths, connected to the camera.
  both,             ///< Camera and light paths, connected to one another.
  photons,          ///< Camera paths that gather photons, which light paths have stored before.
  light_by_chance,  ///< Light paths that enter the camera's opening or hit the probe by chance.
  camera_by_chance  ///< Camera paths that hit lights by chance.
};

/// Vertices of light paths with which camera paths are merged. Merging needs all light paths of a sample
/// first.
enum class Merging : std::uint8_t {
  none,
  nearest,  ///< A number of nearest ones.
  radius    ///< All within a radius that shrinks from sample to sample.
};

/// Scenes for which Integrator::automatic may choose an integrator instead of path tracing.
enum class AutomaticChoice : std::uint8_t {
  never,
  probes,     ///< If pilots find it to be cheaper for a probe that photons can hit.
  films,      ///< If pilots find it to be cheaper for any other sensor.
  consistent  ///< If biased but consistent integrators are allowed, and no other samples some light.
};

/// Properties of an integrator, for everything but its own tracer. With a camera it owns the classes `owned`
/// of paths [Heckbert1990] if it renders alone: E is the camera, S a delta event, D any other event, L the
/// light.
struct IntegratorTraits {
  Integrator integrator;
  const char* name;  ///< Name in scenes, commands and films.
  TracedPaths traces;
  std::string_view owned;
  Merging merging = Merging::none;
  bool repeats_paths = false;       ///< True if all samples have the same camera paths.
  bool traces_environment = false;  ///< True if light paths start at environment lights too.
  bool sampling_options = false;    ///< True if `PathSampling` may differ from its default.
  AutomaticChoice chosen_for = AutomaticChoice::never;
};

/// `IntegratorTraits::owned` of integrators that merge paths.
inline constexpr std::string_view kMergedPaths = "E (S|D)* L, except E S* L of lights without area";

/// Integrators that Integrator::automatic combines: for camera paths, and for the photons of caustics.
inline constexpr Integrator kAutomaticPaths = Integrator::path;
inline constexpr Integrator kAutomaticPhotons = Integrator::light;

/// All integrators, in the order of the enumeration. `automatic` traces what `path` traces.
inline constexpr auto kIntegrators = std::to_array<IntegratorTraits>({
    {.integrator = Integrator::automatic,
     .name = "auto",
     .traces = TracedPaths::camera,
     .owned = "E (S|D)* L"},
    {.integrator = Integrator::path,
     .name = "path",
     .traces = TracedPaths::camera,
     .owned = "E (S|D)* L",
     .sampling_options = true},
    {.integrator = Integrator::light,
     .name = "light",
     .traces = TracedPaths::light,
     .owned = "E D (S|D)* L",
     .chosen_for = AutomaticChoice::probes},
    {.integrator = Integrator::bdpt,
     .name = "bdpt",
     .traces = TracedPaths::both,
     .owned = "E (S|D)* L, except paths to lights without area that have no D next to another D or L",
     .chosen_for = AutomaticChoice::films},
    {.integrator = Integrator::photon_map,
     .name = "photon-map",
     .traces = TracedPaths::photons,
     .owned = kMergedPaths,
     .merging = Merging::nearest,
     .traces_environment = true},
    {.integrator = Integrator::ppm,
     .name = "ppm",
     .traces = TracedPaths::photons,
     .owned = kMergedPaths,
     .merging = Merging::radius,
     .repeats_paths = true,
     .traces_environment = true},
    {.integrator = Integrator::sppm,
     .name = "sppm",
     .traces = TracedPaths::photons,
     .owned = kMergedPaths,
     .merging = Merging::radius,
     .traces_environment = true},
    {.integrator = Integrator::vcm,
     .name = "vcm",
     .traces = TracedPaths::both,
     .owned = kMergedPaths,
     .merging = Merging::radius,
     .traces_environment = true,
     .chosen_for = AutomaticChoice::consistent},
    {.integrator = Integrator::photon_brute,
     .name = "photon-brute",
     .traces = TracedPaths::light_by_chance,
     .owned = "E (S|D)* L if E has an opening of finite size",
     .traces_environment = true},
    {.integrator = Integrator::adjoint_brute,
     .name = "adjoint-brute",
     .traces = TracedPaths::camera_by_chance,
     .owned = "E (S|D)* L of lights with area"},
});

/// Properties of an integrator.
[[nodiscard]] constexpr const IntegratorTraits& traits(Integrator integrator) {
  return kIntegrators.at(static_cast<std::size_t>(integrator));
}
static_assert(std::ranges::all_of(kIntegrators, [](const IntegratorTraits& row) {
  return traits(row.integrator).integrator == row.integrator;
}));

/// The integrator with this role for Integrator::automatic, not `AutomaticChoice::never`.
[[nodiscard]] constexpr Integrator integrator_for(AutomaticChoice role) {
  return std::ranges::find(kIntegrators, role, &IntegratorTraits::chosen_for)->integrator;
}

/// Names of the integrators in scenes, commands and films, in the order of the enumeration.
inline constexpr auto kIntegratorNames = [] {
  std::array<const char*, kIntegrators.size()> names{};
  std::ranges::transform(kIntegrators, names.begin(), &IntegratorTraits::name);
  return names;
}();
/// Name of an integrator in `kIntegratorNames`.
[[nodiscard]] constexpr const char* integrator_name(Integrator integrator) {
  return traits(integrator).name;
}

}  // namespace abbe
