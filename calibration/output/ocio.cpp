#include "calibration/output/ocio.h"

#include <sstream>

#include <OpenColorIO/OpenColorIO.h>
#include <fmt/format.h>

#include "calibration/output/color_spaces.h"
#include "io/atomic_file.h"
#include "io/error.h"

namespace abbe {
namespace {

namespace OCIO = OCIO_NAMESPACE;

constexpr const char* kReferenceSpace = "Linear XYZ-D65";
constexpr const char* kRec709Space = "Linear Rec.709 (sRGB)";
constexpr const char* kAcesSpace = "ACES2065-1";
constexpr const char* kRawSpace = "Raw";
constexpr const char* kDisplayReferenceSpace = "CIE-XYZ-D65";
constexpr const char* kDisplaySpace = "sRGB - Display";
constexpr const char* kViewTransform = "Un-tone-mapped";
constexpr std::size_t kMaxCurveSize = std::size_t{1} << 20;

bool has_curve(const CameraProfile& profile) {
  return !profile.linearisation[0].empty();
}

OCIO::MatrixTransformRcPtr matrix_transform(const Matrix3& m) {
  std::array<double, 16> values{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) values[static_cast<std::size_t>(4 * i + j)] = m[i][j];
  values[15] = 1;
  OCIO::MatrixTransformRcPtr transform = OCIO::MatrixTransform::Create();
  transform->setMatrix(values.data());
  return transform;
}

OCIO::ColorSpaceRcPtr color_space(const char* name, const char* description, OCIO::ReferenceSpaceType type) {
  OCIO::ColorSpaceRcPtr space = OCIO::ColorSpace::Create(type);
  space->setName(name);
  space->setDescription(description);
  space->setBitDepth(OCIO::BIT_DEPTH_F32);
  return space;
}

void add_scene_space(OCIO::Config& config, const char* name, const char* description,
                     const OCIO::ConstTransformRcPtr& to_reference) {
  const OCIO::ColorSpaceRcPtr space = color_space(name, description, OCIO::REFERENCE_SPACE_SCENE);
  space->setEncoding("scene-linear");
  if (to_reference) space->setTransform(to_reference, OCIO::COLORSPACE_DIR_TO_REFERENCE);
  config.addColorSpace(space);
}

void add_camera_space(OCIO::Config& config, const CameraProfile& profile) {
  const OCIO::GroupTransformRcPtr group = OCIO::GroupTransform::Create();
  if (has_curve(profile)) {
    const OCIO::FileTransformRcPtr curve = OCIO::FileTransform::Create();
    curve->setSrc(kCurveFile);
    curve->setInterpolation(OCIO::INTERP_LINEAR);
    group->appendTransform(curve);
  }
  group->appendTransform(matrix_transform(profile.to_xyz_d65));
  const OCIO::ColorSpaceRcPtr space =
      color_space(kCameraSpace, profile.description.c_str(), OCIO::REFERENCE_SPACE_SCENE);
  space->setTransform(group, OCIO::COLORSPACE_DIR_TO_REFERENCE);
  config.addColorSpace(space);
}

// The encoding of IEC 61966-2-1, its linear part continued below zero.
OCIO::ExponentWithLinearTransformRcPtr srgb_encoding() {
  OCIO::ExponentWithLinearTransformRcPtr encoding = OCIO::ExponentWithLinearTransform::Create();
  encoding->setGamma({2.4, 2.4, 2.4, 1});
  encoding->setOffset({0.055, 0.055, 0.055, 0});
  encoding->setNegativeStyle(OCIO::NEGATIVE_LINEAR);
  encoding->setDirection(OCIO::TRANSFORM_DIR_INVERSE);
  return encoding;
}

void add_display(OCIO::Config& config) {
  config.addColorSpace(color_space(kDisplayReferenceSpace, "CIE XYZ of the display, white D65 at Y = 1.",
                                   OCIO::REFERENCE_SPACE_DISPLAY));
  const OCIO::GroupTransformRcPtr group = OCIO::GroupTransform::Create();
  group->appendTransform(matrix_transform(rgb_to_xyz(kRec709).inverse()));
  group->appendTransform(srgb_encoding());
  const OCIO::ColorSpaceRcPtr srgb =
      color_space(kDisplaySpace, "Code values of an sRGB display.", OCIO::REFERENCE_SPACE_DISPLAY);
  srgb->setEncoding("sdr-video");
  srgb->setTransform(group, OCIO::COLORSPACE_DIR_FROM_REFERENCE);
  config.addColorSpace(srgb);

  const OCIO::ViewTransformRcPtr view = OCIO::ViewTransform::Create(OCIO::REFERENCE_SPACE_SCENE);
  view->setName(kViewTransform);
  view->setDescription("The scene's XYZ shown as they are.");
  view->setTransform(OCIO::MatrixTransform::Create(), OCIO::VIEWTRANSFORM_DIR_FROM_REFERENCE);
  config.addViewTransform(view);
  config.setDefaultViewTransformName(kViewTransform);
  config.addDisplayView(kDisplay, kView, kViewTransform, kDisplaySpace, "", "", "");
}

void add_roles(OCIO::Config& config) {
  config.setRole("aces_interchange", kAcesSpace);
  config.setRole("cie_xyz_d65_interchange", kDisplayReferenceSpace);
  config.setRole(OCIO::ROLE_SCENE_LINEAR, kRec709Space);
  config.setRole(OCIO::ROLE_RENDERING, kRec709Space);
  config.setRole(OCIO::ROLE_DATA, kRawSpace);
  config.setRole(OCIO::ROLE_DEFAULT, kRawSpace);
}

OCIO::ConfigRcPtr build_config(const CameraProfile& profile) {
  OCIO::ConfigRcPtr config = OCIO::Config::Create();
  config->setVersion(2, 0);
  config->setDescription(profile.description.c_str());
  config->setSearchPath(".");
  add_scene_space(*config, kReferenceSpace, "CIE XYZ, linear, scene white adapted to D65.", nullptr);
  add_scene_space(*config, kRec709Space, "Rec.709 primaries, linear, white D65.",
                  matrix_transform(rgb_to_xyz(kRec709)));
  const Matrix3 aces_to_d65 =
      bradford(unit_xyz(kAces2065.white), unit_xyz(kD65)).value() * rgb_to_xyz(kAces2065);
  add_scene_space(*config, kAcesSpace, "ACES2065-1: AP0 primaries, linear.", matrix_transform(aces_to_d65));
  add_camera_space(*config, profile);
  const OCIO::ColorSpaceRcPtr raw = color_space(kRawSpace, "No transform.", OCIO::REFERENCE_SPACE_SCENE);
  raw->setIsData(true);
  config->addColorSpace(raw);
  add_display(*config);
  add_roles(*config);
  return config;
}

std::string spi1d_text(const CameraProfile& profile) {
  const auto& [r, g, b] = profile.linearisation;
  std::string text = fmt::format("Version 1\nFrom 0.0 1.0\nLength {}\nComponents 3\n{{\n", r.size());
  for (std::size_t i = 0; i < r.size(); ++i)
    text += fmt::format("{} {} {}\n", static_cast<float>(r[i]), static_cast<float>(g[i]),
                        static_cast<float>(b[i]));
  return text + "}\n";
}

std::string clf_text(const CameraProfile& profile, const OCIO::ConstConfigRcPtr& config) {
  const auto& [r, g, b] = profile.linearisation;
  const OCIO::GroupTransformRcPtr group = OCIO::GroupTransform::Create();
  group->getFormatMetadata().setID("abbe-camera");
  group->getFormatMetadata().addChildElement("Description", profile.description.c_str());
  if (has_curve(profile)) {
    const OCIO::Lut1DTransformRcPtr curve =
        OCIO::Lut1DTransform::Create(static_cast<unsigned long>(r.size()), false);
    curve->setInterpolation(OCIO::INTERP_LINEAR);
    for (std::size_t i = 0; i < r.size(); ++i)
      curve->setValue(static_cast<unsigned long>(i), static_cast<float>(r[i]), static_cast<float>(g[i]),
                      static_cast<float>(b[i]));
    group->appendTransform(curve);
  }
  group->appendTransform(matrix_transform(profile.to_xyz_d65));
  std::ostringstream text;
  group->write(config, "Academy/ASC Common LUT Format", text);
  return text.str();
}

void require_well_formed(const CameraProfile& profile) {
  const std::size_t size = profile.linearisation[0].size();
  for (const std::vector<double>& curve : profile.linearisation)
    if (curve.size() != size || size == 1 || size > kMaxCurveSize)
      throw Error(ErrorCode::internal, "camera profile",
                  "linearisation curves need one common size from 2 to 2^20");
}

template <typename F>
auto with_ocio_errors(ErrorCode code, const F& f) {
  try {
    return f();
  } catch (const OCIO::Exception& e) {
    throw Error(code, "OpenColorIO", e.what());
  }
}

}  // namespace

std::string ocio_config_text(const CameraProfile& profile) {
  require_well_formed(profile);
  return with_ocio_errors(ErrorCode::internal, [&] {
    std::ostringstream text;
    build_config(profile)->serialize(text);
    return text.str();
  });
}

void write_ocio_config(const std::filesystem::path& folder, const CameraProfile& profile) {
  const std::string text = ocio_config_text(profile);
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure)
    throw Error(ErrorCode::output, folder.string(), "cannot create the folder: " + failure.message());
  with_ocio_errors(ErrorCode::output, [&] {
    std::istringstream stream(text);
    const OCIO::ConfigRcPtr config = OCIO::Config::CreateFromStream(stream)->createEditableCopy();
    config->validate();
    config->setWorkingDir(folder.string().c_str());
    if (has_curve(profile)) write_atomically(folder / kCurveFile, spi1d_text(profile));
    write_atomically(folder / kClfFile, clf_text(profile, config));
    static_cast<void>(config->getProcessor(kCameraSpace, kDisplay, kView, OCIO::TRANSFORM_DIR_FORWARD));
  });
  write_atomically(folder / "config.ocio", text);
}

}  // namespace abbe
