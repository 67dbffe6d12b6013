#include <cmath>

#include <fmt/format.h>

#include "tests/scenes/scene_fixture.h"

// Bins of wavelength as a film.

namespace abbe {
namespace {

std::string bins(double from, double to, double step) {
  return fmt::format(
      R"({{"resolution": [160, 90], "pixel_pitch_um": 54, "exposure_s": 0.02, "spectral": {{"from_nm": {}, "to_nm": {}, "step_nm": {}}}}})",
      from, to, step);
}

// A lamp of 1 W between 540 and 550 nm behind the slits: what passes the prism lands in that bin, all of it.
TEST(SpectralFilm, ALineThroughAPrismLandsInOneBinWithItsEnergy) {
  const std::vector<Override> lamp{
      {"/lights/0/emission", R"({"spectrum": {"band": [540, 550]}, "radiant_flux_W": 1})"},
      {"/render/samples", "64"}};
  std::vector<Override> spectral = lamp;
  spectral.push_back({"/sensor", bins(500, 600, 10)});
  std::vector<Override> plain = lamp;
  plain.push_back(
      {"/sensor",
       R"({"resolution": [160, 90], "pixel_pitch_um": 54, "exposure_s": 0.02, "channels": {"all": 1}})"});
  plain.push_back({"/render/seed", "1"});
  const Film film = render(test::load("prism.json", spectral), {}).film;
  const test::Region all = test::whole(render(test::load("prism.json", plain), {}).film, 0);
  ASSERT_EQ(film.channels(), 10);
  for (int bin = 0; bin < 10; ++bin) {
    const test::Region found = test::whole(film, bin);
    if (bin != 4) {
      EXPECT_EQ(found.mean, 0) << bin;
      continue;
    }
    EXPECT_GT(found.mean, 0);
    EXPECT_LT(std::abs(found.mean - all.mean), 5 * std::sqrt(found.variance + all.variance));
    EXPECT_NEAR(found.mean / all.mean, 1, 0.02);
  }
}

// The bin a line stands in, and where on the film: those of its wavelength.
TEST(SpectralFilm, TwoLinesShareNoBin) {
  const Scene scene = test::load(
      "prism.json", {{"/sensor", bins(430, 660, 10)},
                     {"/lights/0/emission", R"({"lines": [{"nm": 486.1327, "width_nm": 0.01, "power": 1},
                                    {"nm": 587.5618, "width_nm": 0.01, "power": 2}], "radiant_flux_W": 1})"},
                     {"/render/samples", "64"}});
  const Film film = render(scene, {}).film;
  double energy[2] = {0, 0};
  double column[2] = {0, 0};
  for (int bin = 0; bin < film.channels(); ++bin) {
    const int line = bin == 5 ? 0 : 1;
    const double found = test::whole(film, bin).mean;
    if (bin != 5 && bin != 15) {
      EXPECT_EQ(found, 0) << bin;
      continue;
    }
    energy[line] = found;
    for (int x = 0; x < film.width(); ++x)
      column[line] += x * test::region(film, bin, x, 0, x + 1, film.height()).mean;
    column[line] /= found * film.width();
  }
  EXPECT_NEAR(energy[1] / energy[0], 2, 0.1);
  EXPECT_GT(column[1], column[0] + 30) << "red lies to the right";
}

// Family significance 1e-6 over 8 bins x 4 regions.
TEST(SpectralFilm, PathsAndPhotonsFillBinsWithOneUnit) {
  const std::string sensor =
      R"({"resolution": [48, 48], "pixel_pitch_um": 520.8333, "spectral": {"from_nm": 380, "to_nm": 780, "step_nm": 50}})";
  const auto film = [&sensor](const char* integrator) {
    return render(test::load(
                      "cornell.json",
                      {{"/sensor", sensor}, {"/render/samples", "256"}, {"/render/integrator", integrator}}),
                  {})
        .film;
  };
  const Film path = film("path");
  const Film light = film("light");
  for (int bin = 0; bin < path.channels(); ++bin)
    for (int i = 0; i < 4; ++i) {
      const test::Region a = test::region(path, bin, 12 * i, 12, 12 * i + 12, 48);
      const test::Region b = test::region(light, bin, 12 * i, 12, 12 * i + 12, 48);
      EXPECT_LT(std::abs(a.mean - b.mean), 5.6 * std::sqrt(a.variance + b.variance)) << bin << ' ' << i;
      if (a.mean > 0.05 * test::whole(path, 5).mean) {
        EXPECT_NEAR(b.mean / a.mean, 1, 0.1) << bin << ' ' << i;
      }
    }
}

}  // namespace
}  // namespace abbe
