// Cameras of other renderers: what their lenses and their films become.
#include <cmath>
#include <string>

#include "pbrt_scenes.h"

namespace abbe {
namespace {

using test::PbrtTest;

TEST_F(PbrtTest, LensesExposeAsThePinholeDoes) {
  for (const char* radius : {"0.001", "0.05", "0.5"}) {
    SCOPED_TRACE(radius);
    const auto made = convert("a.pbrt",
                              "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 8\nScale -1 1 "
                              "1\nCamera \"perspective\" \"float fov\" 40 \"float lensradius\" " +
                                  std::string(radius) + " \"float focaldistance\" 5\nWorldBegin\n");
    ASSERT_TRUE(made) << told_;
    const auto& lens = std::get<spec::ThinLensCamera>(made->camera->kind).lens;
    const double f = lens.focal_length;
    const double image_distance = 1 / (1 / f - 1.0 / 5);
    EXPECT_NEAR(f / lens.aperture.f_number.value() / 2, std::stod(radius), 1e-9);
    // The number that the pinhole has by default.
    EXPECT_NEAR(image_distance / (2 * std::stod(radius)), 4, 1e-9);
    EXPECT_NEAR(2 * std::atan(8 * made->sensor->pixel_pitch_um * 1e-6 / 2 / image_distance) * 180 / M_PI, 40,
                1e-9);
  }
}

// Beyond 7/8 of the focus distance the film of the pinhole's exposure would need a lens faster than f/0.5.
TEST_F(PbrtTest, LensesWiderThanAnyInAirAreNarrowedWithANote) {
  const auto made = convert("a.pbrt",
                            "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 8\nScale -1 1 "
                            "1\nCamera \"perspective\" \"float fov\" 40 \"float lensradius\" 0.04 \"float "
                            "focaldistance\" 0.02\nWorldBegin\n");
  ASSERT_TRUE(made) << told_;
  EXPECT_TRUE(tells("the lens is too wide for its focus distance: its radius is 0.0175, not 0.04")) << told_;
  const auto& lens = std::get<spec::ThinLensCamera>(made->camera->kind).lens;
  EXPECT_EQ(lens.aperture.f_number, 0.5);
  EXPECT_NEAR(lens.focal_length, 0.0175, 1e-12);
}

// Its lens and its focus are in the camera's own coordinates.
TEST_F(PbrtTest, ScaledCamerasHaveScaledLenses) {
  const auto lens_of = [this](const std::string& scale) {
    const auto made = convert("a.pbrt", "Scale " + scale +
                                            "\nCamera \"perspective\" \"float lensradius\" 0.1 \"float "
                                            "focaldistance\" 5\nWorldBegin\n");
    EXPECT_TRUE(made) << told_;
    return std::get<spec::ThinLensCamera>(made.value().camera->kind).lens;
  };
  const std::string uneven = "a non-uniform scale of the camera is not supported";
  for (const double world : {1.0, 0.5, 4.0}) {
    const auto lens = lens_of(fmt::format("-{0} {0} {0}", 1 / world));
    EXPECT_NEAR(lens.focal_length / lens.aperture.f_number.value() / 2, 0.1 * world, 1e-9);
    EXPECT_NEAR(std::get<double>(lens.focus_distance.value()), 5 * world, 1e-9);
    EXPECT_FALSE(tells(uneven)) << told_;
  }
  for (const char* scale : {"-1 2 2", "-2 1 2", "-1 1 2"}) {
    (void)lens_of(scale);
    EXPECT_TRUE(tells(uneven)) << scale;
  }
}

// By cos^4 of the angle at a corner, which is 1/(1 + 2 tan(fov/2)^2)^2 of a square.
TEST_F(PbrtTest, DarkCornersAreTold) {
  const auto told_of = [this](const std::string& camera, const std::string& film) {
    EXPECT_TRUE(
        convert("a.pbrt", "Film \"" + film +
                              "\" \"integer xresolution\" 16 \"integer yresolution\" 16\nScale -1 1 1\n"
                              "Camera \"perspective\" " +
                              camera + "\nWorldBegin\n"))
        << told_;
    return tells("the picture darkens towards its corners");
  };
  EXPECT_TRUE(told_of("\"float fov\" 90", "rgb"));
  EXPECT_TRUE(
      tells("a.pbrt:3:1: warning: the picture darkens towards its corners by cos^4 of the angle to the axis, "
            "to 0.11 of its center: that of the source renderer does not"))
      << told_;
  EXPECT_TRUE(told_of("\"float fov\" 90 \"float lensradius\" 0.01 \"float focaldistance\" 5", "rgb"));
  EXPECT_TRUE(tells("to 0.11 of its center")) << told_;
  EXPECT_TRUE(told_of("\"float fov\" 20", "rgb")) << "0.8863";
  EXPECT_FALSE(told_of("\"float fov\" 18", "rgb")) << "0.9074";
  EXPECT_FALSE(told_of("\"float fov\" 90", "spectral")) << "it holds radiances";
}

}  // namespace
}  // namespace abbe
