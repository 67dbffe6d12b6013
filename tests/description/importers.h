#pragma once

#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include <fmt/format.h>

#include "description/scene.h"
#include "importers/importers.h"
#include "io/exr.h"
#include "io/picture.h"
#include "io/schema/read.h"

namespace abbe::test {

/// Converts scenes of other renderers in a folder of their own.
class ImportersTest : public ::testing::Test {
 protected:
  ImportersTest()
      : folder_(std::filesystem::temp_directory_path() / fmt::format("abbe_importers_{}", ::getpid())) {
    std::filesystem::create_directories(folder_);
    put("square.ply",
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n");
  }
  ~ImportersTest() override { std::filesystem::remove_all(folder_); }

  // An image of one pixel, which may be a colour, a height or a normal: of one channel, or of R, G and B.
  void put_image(const std::string& name, bool grey) const {
    std::vector<ImageChannel> channels{{"R", {0.5F}}, {"G", {0.5F}}, {"B", {1}}};
    if (grey) channels = {{"Y", {0.5F}}};
    const Image image{1, 1, channels, {}};
    if (name.ends_with(".exr"))
      write_exr(folder_ / name, image);
    else
      write_picture(folder_ / name, image);
  }

  void put(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }

  // The text that a file is converted to, nothing after an error; `told_` is all that is said then.
  std::optional<std::string> written(const std::string& name, const std::string& text,
                                     const std::string& materials = "") {
    put(name, text);
    Diagnostics diagnostics;
    ConversionOptions conversion{folder_, {}};
    if (!materials.empty()) {
      put("materials.json", materials);
      conversion.materials = folder_ / "materials.json";
    }
    auto written = convert_scene(folder_ / name, conversion, diagnostics);
    told_ = diagnostics.text();
    code_ = diagnostics.code();
    return written;
  }
  // The same as a scene.
  std::optional<spec::Scene> convert(const std::string& name, const std::string& text,
                                     const std::string& materials = "") {
    const auto json_text = written(name, text, materials);
    if (!json_text) return std::nullopt;
    Diagnostics diagnostics;
    const auto json =
        parse_json(std::make_shared<const SourceText>(SourceText{"written", *json_text}), diagnostics);
    told_ += diagnostics.text();
    return json ? schema::read<spec::Scene>(*json, diagnostics) : std::nullopt;
  }

  [[nodiscard]] bool tells(const std::string& what) const { return told_.find(what) != std::string::npos; }

  // Every beginning of a sound file is a scene or an error, and nothing worse.
  void expect_no_crash_at_any_prefix(const std::string& name, const std::string& text) {
    ASSERT_TRUE(convert(name, text)) << told_;
    std::size_t sound = 0;
    for (std::size_t length = 0; length < text.size(); ++length) {
      const bool good = convert(name, text.substr(0, length)).has_value();
      sound += good;
      EXPECT_EQ(good, !tells("error:")) << length << ": " << told_;
      if (!good) {
        EXPECT_TRUE(tells(name + ":")) << length << ": " << told_;
      }
    }
    EXPECT_LT(sound, text.size());
  }

  std::filesystem::path folder_;
  std::string told_;
  std::optional<ErrorCode> code_;  // Of the last conversion.
};

struct DoorFault {
  const char* what;
  std::string text;
  std::string message;  ///< With its place.
};

}  // namespace abbe::test
