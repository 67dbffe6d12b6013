#include "cli/ray_commands.h"

#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "cli/draw.h"
#include "cli/lens.h"
#include "cli/trace.h"

namespace abbe::cli {
namespace {

void add_follow(CLI::App& app, Follow& follow) {
  add_parsed(
      app, "--follow", follow, one_of<Follow>({"refraction", "reflection", "both"}),
      "Which way where a surface reflects and lets through (default: refraction); both follows all, in "
      "branches",
      "refraction|reflection|both");
}

// In units of its own I.
StokesVector parse_stokes(const std::string& option, const std::string& text) {
  const std::vector<double> given = parse_numbers(option, text, -1e30, 1e30);
  const auto fault = [&](std::string_view allowed) {
    return Error(ErrorCode::usage, option, fmt::format("got \"{}\", allowed {}", text, allowed));
  };
  if (given.size() != 4) throw fault("four numbers I,Q,U,V");
  const double polarised = std::hypot(given[1], given[2], given[3]);
  if (!(given[0] > 0) || polarised > given[0] * (1 + 1e-9))
    throw fault("I above 0 and Q, U, V of light that is not polarised by more than all of it");
  return {1, given[1] / given[0], given[2] / given[0], given[3] / given[0]};
}

}  // namespace

void add_trace(CLI::App& app, Command& command) {
  const Sub<TraceOptions> sub(app, "trace", "Follow one ray through a scene in double precision", command,
                              trace);
  sub.app->add_option("scene", sub->scene, "Scene file, or - for standard input")
      ->required()
      ->type_name("SCENE");
  add_parsed(*sub.app, "--lambda", sub->wavelength_nm, number_in(kMinWavelengthNm, kMaxWavelengthNm),
             "Wavelength in standard air", "NM")
      ->required();
  CLI::Option* origin = add_parsed(*sub.app, "--origin", sub->origin, parse_vector,
                                   "Where the ray starts, in scene units", "X,Y,Z");
  add_parsed(*sub.app, "--dir", sub->direction, parse_vector, "Its direction, of any length", "X,Y,Z");
  sub.app
      ->add_option(
          "--from-light", sub->light,
          "Start at this light, in the middle of what it lights unless --dir tells another direction")
      ->type_name("NAME")
      ->excludes(origin);
  add_parsed(*sub.app, "--max-events", sub->max_events, integer_in<int>(1, 1000000),
             "Events to follow at most (default 64)", "N");
  add_follow(*sub.app, sub->follow);
  add_parsed(
      *sub.app, "--stokes", sub->stokes, parse_stokes,
      "Stokes vector of the light that sets out (default 1,0,0,0), in the frame of the answer's first_axis",
      "I,Q,U,V");
  add_overrides(*sub.app, sub.options);
  add_max_memory(*sub.app, sub.options);
  add_json(*sub.app, sub->json);
}

void add_draw(CLI::App& app, Command& command) {
  const Sub<DrawOptions> sub(app, "draw", "Draw plan and elevation of a scene, with rays", command, draw);
  sub.app->add_option("scene", sub->scene, "Scene file, or - for standard input")
      ->required()
      ->type_name("SCENE");
  sub.app->add_option("-o,--output", sub->output, "Drawing to write")->required()->type_name("FILE.svg");
  add_parsed(*sub.app, "--lambda", sub->wavelengths_nm, numbers_in(kMinWavelengthNm, kMaxWavelengthNm),
             "Wavelengths of the rays (default 450,550,650)", "NM,...");
  CLI::Option* rays = add_parsed(*sub.app, "--rays", sub->rays, integer_in<int>(0, 1000),
                                 "Rays of each lamp in each of two planes (default 9)", "N");
  CLI::Option* origin =
      add_parsed(*sub.app, "--origin", sub->origin, parse_vector,
                 "Where one ray starts, in place of those of lamps, in scene units", "X,Y,Z");
  CLI::Option* direction =
      add_parsed(*sub.app, "--dir", sub->direction, parse_vector, "Its direction, of any length", "X,Y,Z");
  origin->needs(direction)->excludes(rays);
  direction->needs(origin);
  add_parsed(*sub.app, "--max-events", sub->max_events, integer_in<int>(1, 1000000),
             "Events to follow at most (default 64)", "N");
  add_follow(*sub.app, sub->follow);
  add_overrides(*sub.app, sub.options);
  add_max_memory(*sub.app, sub.options);
}

void add_lens(CLI::App& app, Command& command) {
  const Sub<LensOptions> sub(app, "lens", "Say what a lens does: first order, aberrations, spots, losses",
                             command, lens);
  sub.app
      ->add_option("lens", sub->lens,
                   "Prescription, a lens of Zemax, a table as pbrt reads it, or a name of data/lens")
      ->required()
      ->type_name("FILE.json|FILE.zmx|FILE.dat");
  add_parsed(*sub.app, "--lambda", sub->wavelengths_nm, numbers_in(kMinWavelengthNm, kMaxWavelengthNm),
             "Wavelengths in place of the lens's, the middle one being the primary; stop and focus stay as "
             "set at its own",
             "NM,...");
  add_parsed(*sub.app, "--frequencies", sub->frequencies_per_mm, numbers_in(1e-3, 1e4),
             "Lines per mm to tell the modulation at (default 10,20,40)", "N,...");
  sub.app->add_option("--html", sub->html, "Page to write")->type_name("FILE.html");
  sub.app->add_option("-o,--output", sub->drawing, "Drawing of the lens to write")->type_name("FILE.svg");
  add_json(*sub.app, sub->json);
}

}  // namespace abbe::cli
