#include "calibration/output/ocio.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <sstream>
#include <string_view>

#include <OpenColorIO/OpenColorIO.h>
#include <fmt/format.h>

#include "calibration/chart/delta_e.h"
#include "calibration/output/color_spaces.h"
#include "io/atomic_file.h"
#include "io/error.h"
#include "io/text.h"

namespace abbe {
namespace {

namespace OCIO = OCIO_NAMESPACE;

constexpr const char* kRec709Space = "Linear Rec.709 (sRGB)";
constexpr const char* kAcesSpace = "ACES2065-1";
constexpr const char* kAcesCgSpace = "ACEScg";
constexpr const char* kRawSpace = "Raw";
constexpr const char* kDiffuserPhrase =
    "the perfect diffuser, which becomes Y = 1, has ";  // marks camera spaces
constexpr const char* kDisplayReferenceSpace = "CIE-XYZ-D65";
struct DisplaySpace {
  const char* name;
  const char* style;
  const char* description;
  DisplayCodes codes;
};
const std::array kDisplaySpaces{
    DisplaySpace{
        kSrgbDisplay, "DISPLAY - CIE-XYZ-D65_to_sRGB", "Code values of an sRGB display.", {"sRGB", kRec709}},
    DisplaySpace{kRec1886Display,
                 "DISPLAY - CIE-XYZ-D65_to_REC.1886-REC.709",
                 "Code values of a Rec.709 video display.",
                 {"Gamma2.4", kRec709}},
    DisplaySpace{kP3Display,
                 "DISPLAY - CIE-XYZ-D65_to_G2.6-P3-D65",
                 "Code values of a P3 projector with white D65.",
                 {"Gamma2.6", kP3D65}}};
constexpr const char* kAcesOutput = "ACES-OUTPUT - ACES2065-1_to_CIE-XYZ-D65 - SDR-VIDEO_1.0";
constexpr std::size_t kMaxCurveSize = std::size_t{1} << 20;
constexpr int kCubeEdge = 65;
// Test points of the bake error in half steps of the cube, from 0.2 % of its end on.
constexpr int kDarkestTrial = 17;
constexpr int kBrightTrials = 49;
constexpr int kBrightStride = 6;
constexpr double kDarkestChart = 0.125;  // as a fraction of full scale, in a useful photograph

bool has_curve(const CameraProfile& profile) {
  return !profile.linearisation[0].empty();
}

bool has_cube(const CameraProfile& profile) {
  return profile.correction.model != CorrectionModel::linear;
}

// Linear value at the end of a cube, which clips larger ones: 1 for fractions of full scale, else the next
// power of two above all calibrated values, where digital numbers end too. The nearer the chart is to the
// end, the finer is the cube at its colours.
double cube_end(const CameraProfile& profile) {
  if (has_curve(profile)) return 1;
  const Raw white = white_values(profile);
  const double brightest = std::max({white[0], white[1], white[2], profile.brightest_patch});
  if (kDarkestChart <= brightest && brightest <= 1) return 1;
  return std::exp2(std::ceil(std::log2(brightest)));
}

// Description of a camera space, including the scale of its input.
std::string space_description(const CameraProfile& profile) {
  const Raw white = white_values(profile);
  return fmt::format(
      "{}. Input: {}; {}{}{} {:.6g}, {} {:.6g}, {} {:.6g}.{}", profile.description,
      has_curve(profile) ? "code values, 1 at full scale" : "linear camera values", kDiffuserPhrase,
      has_curve(profile) ? "after the curve " : "", profile.channels[0], white[0], profile.channels[1],
      white[1], profile.channels[2], white[2],
      has_cube(profile) ? fmt::format(" Linear values are cut to [0, {:.6g}].", cube_end(profile)) : "");
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

OCIO::FileTransformRcPtr file_transform(const std::string& file, OCIO::Interpolation interpolation) {
  OCIO::FileTransformRcPtr transform = OCIO::FileTransform::Create();
  transform->setSrc(file.c_str());
  transform->setInterpolation(interpolation);
  return transform;
}

OCIO::BuiltinTransformRcPtr builtin(const char* style) {
  OCIO::BuiltinTransformRcPtr transform = OCIO::BuiltinTransform::Create();
  transform->setStyle(style);
  return transform;
}

// Cube roots of the input make the cube perceptually even, with fine steps in the dark.
OCIO::ExponentTransformRcPtr cube_root() {
  OCIO::ExponentTransformRcPtr transform = OCIO::ExponentTransform::Create();
  transform->setValue({1.0 / 3, 1.0 / 3, 1.0 / 3, 1});
  return transform;
}

// The input is scaled to [0, 1], the range of the cube.
void append_cube(const OCIO::GroupTransformRcPtr& group, const CameraProfile& profile) {
  const double end = cube_end(profile);
  if (end != 1) group->appendTransform(matrix_transform(diagonal({1 / end, 1 / end, 1 / end})));
  group->appendTransform(cube_root());
  group->appendTransform(file_transform(camera_file(profile, ".cube"), OCIO::INTERP_TETRAHEDRAL));
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
  if (has_curve(profile))
    group->appendTransform(file_transform(camera_file(profile, ".spi1d"), OCIO::INTERP_LINEAR));
  if (has_cube(profile))
    append_cube(group, profile);
  else
    group->appendTransform(matrix_transform(matrix_to_xyz_d65(profile)));
  const OCIO::ColorSpaceRcPtr space = color_space(
      camera_space(profile).c_str(), space_description(profile).c_str(), OCIO::REFERENCE_SPACE_SCENE);
  space->setTransform(group, OCIO::COLORSPACE_DIR_TO_REFERENCE);
  config.addColorSpace(space);
}

void add_view_transform(OCIO::Config& config, const char* name, const char* description,
                        const OCIO::ConstTransformRcPtr& from_scene) {
  const OCIO::ViewTransformRcPtr view = OCIO::ViewTransform::Create(OCIO::REFERENCE_SPACE_SCENE);
  view->setName(name);
  view->setDescription(description);
  view->setTransform(from_scene, OCIO::VIEWTRANSFORM_DIR_FROM_REFERENCE);
  config.addViewTransform(view);
}

void add_displays(OCIO::Config& config) {
  config.addColorSpace(color_space(kDisplayReferenceSpace, "CIE XYZ of the display, white D65 at Y = 1.",
                                   OCIO::REFERENCE_SPACE_DISPLAY));
  add_view_transform(config, kPlainView, "The scene's XYZ shown as they are.",
                     OCIO::MatrixTransform::Create());
  const OCIO::GroupTransformRcPtr aces = OCIO::GroupTransform::Create();
  aces->appendTransform(matrix_transform(rgb_to_xyz_d65(kAces2065).inverse()));
  aces->appendTransform(builtin(kAcesOutput));
  add_view_transform(config, kAcesView, "The rendering and output transform of ACES 1.0.", aces);
  config.setDefaultViewTransformName(kPlainView);
  for (const auto& [name, style, description, codes] : kDisplaySpaces) {
    const OCIO::ColorSpaceRcPtr space = color_space(name, description, OCIO::REFERENCE_SPACE_DISPLAY);
    space->setEncoding("sdr-video");
    space->setTransform(builtin(style), OCIO::COLORSPACE_DIR_FROM_REFERENCE);
    config.addColorSpace(space);
    for (const char* view : {kPlainView, kAcesView})
      config.addDisplayView(name, view, view, name, "", "", "");
  }
}

void add_roles(OCIO::Config& config) {
  config.setRole("aces_interchange", kAcesSpace);
  config.setRole("cie_xyz_d65_interchange", kDisplayReferenceSpace);
  for (const char* role : {OCIO::ROLE_SCENE_LINEAR, OCIO::ROLE_RENDERING}) config.setRole(role, kAcesCgSpace);
  for (const char* role : {OCIO::ROLE_DATA, OCIO::ROLE_DEFAULT}) config.setRole(role, kRawSpace);
  for (const char* role : {OCIO::ROLE_COLOR_PICKING, OCIO::ROLE_TEXTURE_PAINT, OCIO::ROLE_MATTE_PAINT})
    config.setRole(role, kRec709Space);
}

OCIO::ConfigRcPtr build_config(std::span<const CameraProfile> profiles) {
  OCIO::ConfigRcPtr config = OCIO::Config::Create();
  config->setVersion(2, 1);
  config->setSearchPath(".");
  add_scene_space(*config, kReferenceSpace, "CIE XYZ, linear, scene white adapted to D65.", nullptr);
  add_scene_space(*config, kAcesSpace, "AP0 primaries, linear, white adapted from D65 by Bradford's cones.",
                  matrix_transform(rgb_to_xyz_d65(kAces2065)));
  add_scene_space(*config, kAcesCgSpace, "AP1 primaries, linear, white adapted from D65 by Bradford's cones.",
                  matrix_transform(rgb_to_xyz_d65(kAcesCg)));
  add_scene_space(*config, kRec709Space, "Rec.709 primaries, linear, white D65.",
                  matrix_transform(rgb_to_xyz(kRec709)));
  std::string descriptions;
  for (const CameraProfile& profile : profiles) {
    add_camera_space(*config, profile);
    descriptions += (descriptions.empty() ? "" : "; ") + profile.description;
  }
  config->setDescription(descriptions.c_str());
  const OCIO::ColorSpaceRcPtr raw = color_space(kRawSpace, "No transform.", OCIO::REFERENCE_SPACE_SCENE);
  raw->setIsData(true);
  config->addColorSpace(raw);
  add_displays(*config);
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

std::string cube_text(const CameraProfile& profile) {
  const double end = cube_end(profile);
  std::string text = fmt::format("# cube roots of linear camera values{} to XYZ, D65\nLUT_3D_SIZE {}\n",
                                 end == 1 ? "" : fmt::format(" over {:.17g}", end), kCubeEdge);
  const auto value = [end](int i) { return end * std::pow(static_cast<double>(i) / (kCubeEdge - 1), 3); };
  for (int b = 0; b < kCubeEdge; ++b)
    for (int g = 0; g < kCubeEdge; ++g)
      for (int r = 0; r < kCubeEdge; ++r) {
        const XYZ xyz = to_xyz_d65(profile, {value(r), value(g), value(b)});
        text += fmt::format("{:.9g} {:.9g} {:.9g}\n", xyz[0], xyz[1], xyz[2]);
      }
  return text;
}

// Transform from a camera space to another space, as one file without references.
std::string clf_text(const OCIO::ConstConfigRcPtr& config, const CameraProfile& profile, const char* to) {
  const OCIO::GroupTransformRcPtr group =
      config->getProcessor(camera_space(profile).c_str(), to)->createGroupTransform();
  OCIO::FormatMetadata& metadata = group->getFormatMetadata();
  metadata.setID(fmt::format("abbe-{}-to-{}", camera_file(profile, ""), to).c_str());
  metadata.addChildElement("Description", space_description(profile).c_str());
  metadata.addChildElement("InputDescriptor",
                           has_curve(profile) ? "camera code values" : "linear camera values");
  metadata.addChildElement("OutputDescriptor", to);
  std::ostringstream text;
  group->write(config, "Academy/ASC Common LUT Format", text);
  return text.str();
}

// Linear test values at the points of the cube and half way between them, where interpolation errs most. All
// dark values are tested, where errors are most visible, and some of the others.
std::vector<double> bake_trials(double end) {
  std::vector<double> values;
  const int half_steps = 2 * (kCubeEdge - 1);
  for (int i = kDarkestTrial; i < half_steps; i += i < kBrightTrials ? 1 : kBrightStride)
    values.push_back(end * std::pow(static_cast<double>(i) / half_steps, 3));
  return values;
}

double bake_error(const OCIO::ConstConfigRcPtr& config, const CameraProfile& profile) {
  const OCIO::GroupTransformRcPtr baked = OCIO::GroupTransform::Create();
  append_cube(baked, profile);
  const auto processor = config->getProcessor(baked)->getOptimizedCPUProcessor(OCIO::OPTIMIZATION_LOSSLESS);
  const XYZ white = unit_xyz(kD65);
  const auto loss = [&](const Raw& raw) {
    float rgb[3] = {static_cast<float>(raw[0]), static_cast<float>(raw[1]), static_cast<float>(raw[2])};
    processor->applyRGB(rgb);
    const Lab baked_lab = xyz_to_lab(XYZ{rgb[0], rgb[1], rgb[2]}, white);
    return delta_e_2000(xyz_to_lab(to_xyz_d65(profile, raw), white), baked_lab);
  };
  const std::vector<double> values = bake_trials(cube_end(profile));
  double worst = 0;
  for (const double r : values)
    for (const double g : values)
      for (const double b : values) worst = std::max(worst, loss({r, g, b}));
  return worst;
}

Matrix3 matrix_of(const OCIO::MatrixTransform& transform) {
  std::array<double, 16> values{};
  transform.getMatrix(values.data());
  Matrix3 m;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) m[i][j] = values[static_cast<std::size_t>(4 * i + j)];
  return m;
}

// Matrix of a camera space without its response curve; empty if the space has another transform.
std::optional<Matrix3> camera_matrix(const OCIO::ConstTransformRcPtr& transform) {
  if (const auto* matrix = dynamic_cast<const OCIO::MatrixTransform*>(transform.get()))
    return matrix_of(*matrix);
  const auto* group = dynamic_cast<const OCIO::GroupTransform*>(transform.get());
  std::optional<Matrix3> found;
  for (int i = 0; group != nullptr && i < group->getNumTransforms(); ++i) {
    const OCIO::ConstTransformRcPtr child = group->getTransform(i);
    const auto* file = dynamic_cast<const OCIO::FileTransform*>(child.get());
    if (file != nullptr && std::string_view(file->getSrc()).ends_with(".spi1d")) continue;
    const auto* matrix = dynamic_cast<const OCIO::MatrixTransform*>(child.get());
    if (matrix == nullptr || found) return std::nullopt;
    found = matrix_of(*matrix);
  }
  return found;
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

const DisplayCodes& codes_of_display(const std::string& display) {
  for (const DisplaySpace& space : kDisplaySpaces)
    if (display == space.name) return space.codes;
  throw Error(ErrorCode::internal, display, "is no display of the configuration");
}

std::string camera_space(const CameraProfile& profile) {
  return valid_utf8(kCameraPrefix + profile.light);
}

std::string camera_file(const CameraProfile& profile, const std::string& extension) {
  std::string name = "camera_" + profile.light;
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '.' && c != '-') c = '_';
  return name + extension;
}

std::string ocio_config_text(std::span<const CameraProfile> profiles) {
  for (const CameraProfile& profile : profiles) require_well_formed(profile);
  return with_ocio_errors(ErrorCode::internal, [&] {
    std::ostringstream text;
    build_config(profiles)->serialize(text);
    return text.str();
  });
}

std::vector<OcioCameraSpace> camera_spaces(const std::filesystem::path& config_file) {
  return with_ocio_errors(ErrorCode::input, [&] {
    const OCIO::ConstConfigRcPtr config = OCIO::Config::CreateFromFile(config_file.c_str());
    std::vector<OcioCameraSpace> spaces;
    for (int i = 0; i < config->getNumColorSpaces(); ++i) {
      const char* name = config->getColorSpaceNameByIndex(i);
      const OCIO::ConstColorSpaceRcPtr space = config->getColorSpace(name);
      if (!std::string_view(name).starts_with(kCameraPrefix) ||
          std::string_view(space->getDescription()).find(kDiffuserPhrase) == std::string_view::npos)
        continue;
      spaces.push_back({name, camera_matrix(space->getTransform(OCIO::COLORSPACE_DIR_TO_REFERENCE))});
    }
    return spaces;
  });
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure)
    throw Error(ErrorCode::output, folder.string(), "cannot create the folder: " + failure.message());
}

WrittenConfig write_ocio_config(const std::filesystem::path& folder,
                                std::span<const CameraProfile> profiles) {
  const std::string text = ocio_config_text(profiles);
  make_folder(folder);
  WrittenConfig written;
  const auto write = [&](const std::string& name, const std::string& content) {
    written.files.push_back(folder / name);
    write_atomically(written.files.back(), content);
  };
  with_ocio_errors(ErrorCode::output, [&] {
    std::istringstream stream(text);
    const OCIO::ConfigRcPtr config = OCIO::Config::CreateFromStream(stream)->createEditableCopy();
    config->validate();
    config->setWorkingDir(folder.string().c_str());
    for (const CameraProfile& profile : profiles) {
      if (has_curve(profile)) write(camera_file(profile, ".spi1d"), spi1d_text(profile));
      if (has_cube(profile)) {
        write(camera_file(profile, ".cube"), cube_text(profile));
        written.bake_error = std::max(written.bake_error, bake_error(config, profile));
      }
      write(camera_file(profile, ".clf"), clf_text(config, profile, kReferenceSpace));
      write(camera_file(profile, "_to_aces.clf"), clf_text(config, profile, kAcesSpace));
    }
  });
  write("config.ocio", text);
  return written;
}

}  // namespace abbe
