#include "cli/command_options.h"

#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "cli/rays.h"

namespace abbe::cli {
namespace {

void add_follow(CLI::App& app, Follow& follow) {
  add_parsed(app, "--follow", follow, one_of<Follow>({"refraction", "reflection", "both"}),
             "Ray to follow at a surface that both reflects and transmits; both follows all, in branches "
             "(default: refraction)",
             "refraction|reflection|both");
}

// Stokes vector divided by its I.
StokesVector parse_stokes(const std::string& option, const std::string& text) {
  const std::vector<double> given = parse_numbers(option, text, -1e30, 1e30);
  const auto fault = [&](std::string_view allowed) {
    return Error(ErrorCode::usage, option, fmt::format("got \"{}\", allowed {}", text, allowed));
  };
  if (given.size() != 4) throw fault("four numbers I,Q,U,V");
  const double polarised = std::hypot(given[1], given[2], given[3]);
  if (!(given[0] > 0) || polarised > given[0] * (1 + 1e-9))
    throw fault("I > 0 and a degree of polarisation sqrt(Q^2 + U^2 + V^2) / I of at most 1");
  return {1, given[1] / given[0], given[2] / given[0], given[3] / given[0]};
}

}  // namespace

void add_trace(CLI::App& app, Command& command) {
  const Subcommand<TraceOptions> sub(app, "trace", "Trace one ray through a scene in double precision",
                                     command, trace);
  add_scene(*sub.app, sub->scene);
  add_parsed(*sub.app, "--lambda", sub->wavelength_nm, number_in(kMinWavelengthNm, kMaxWavelengthNm),
             "Wavelength in standard air in nm", "NM")
      ->required();
  CLI::Option* origin = add_parsed(*sub.app, "--origin", sub->origin, parse_vector,
                                   "Origin of the ray, in the units of the scene", "X,Y,Z");
  add_parsed(*sub.app, "--dir", sub->direction, parse_vector, "Direction of the ray, of any length", "X,Y,Z");
  add_value(*sub.app, "--from-light", sub->light,
            "Start at this light along its central ray, or in the direction of --dir", "NAME")
      ->excludes(origin);
  add_parsed(*sub.app, "--max-events", sub->max_events, integer_in<int>(1, 1000000),
             "Maximum number of events (default 64)", "N");
  add_follow(*sub.app, sub->follow);
  add_parsed(*sub.app, "--stokes", sub->stokes, parse_stokes,
             "Stokes vector of the emitted light, in the frame of first_axis in the answer (default 1,0,0,0)",
             "I,Q,U,V");
  add_overrides(*sub.app, sub.options);
  add_max_memory(*sub.app, sub.options);
  add_json(*sub.app, sub->json);
}

void add_draw(CLI::App& app, Command& command) {
  const Subcommand<DrawOptions> sub(app, "draw", "Draw the plan and elevation of a scene with rays", command,
                                    draw);
  add_scene(*sub.app, sub->scene);
  add_value(*sub.app, "-o,--output", sub->output, "Drawing to write", "FILE.svg")->required();
  add_parsed(*sub.app, "--lambda", sub->wavelengths_nm, numbers_in(kMinWavelengthNm, kMaxWavelengthNm),
             "Wavelengths of the rays in nm (default 450,550,650)", "NM,...");
  CLI::Option* rays =
      add_parsed(*sub.app, "--rays", sub->rays, integer_in<int>(0, 1000),
                 "Rays per light and wavelength in each of two planes; 0 for none (default 9)", "N");
  CLI::Option* origin = add_parsed(
      *sub.app, "--origin", sub->origin, parse_vector,
      "Origin of a single ray that replaces the rays of the lights, in the units of the scene", "X,Y,Z");
  CLI::Option* direction = add_parsed(*sub.app, "--dir", sub->direction, parse_vector,
                                      "Direction of the ray, of any length", "X,Y,Z");
  origin->needs(direction)->excludes(rays);
  direction->needs(origin);
  add_parsed(*sub.app, "--max-events", sub->max_events, integer_in<int>(1, 1000000),
             "Maximum number of events (default 64)", "N");
  add_follow(*sub.app, sub->follow);
  add_overrides(*sub.app, sub.options);
  add_max_memory(*sub.app, sub.options);
}

}  // namespace abbe::cli
