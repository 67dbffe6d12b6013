#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <utility>

#include "description/lens_files.h"
#include "io/error.h"

namespace abbe::test {

/// Reads a lens of `data/lens` or of a file, with its diagnostics.
struct LoadedLens {
  std::optional<lens::System> system;
  Diagnostics diagnostics;

  [[nodiscard]] std::string text() const { return diagnostics.text(); }
};

inline LoadedLens load_said(const std::string& name) {
  LoadedLens loaded;
  loaded.system = load_lens(name, loaded.diagnostics);
  return loaded;
}

inline lens::System lens_named(const std::string& name) {
  LoadedLens loaded = load_said(name);
  if (!loaded.system) throw Error(ErrorCode::scene, name, loaded.text());
  return *std::move(loaded.system);
}

/// Reads a lens from a text in a file with this extension.
inline LoadedLens lens_of(const std::string& text, const std::string& extension = ".json") {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("abbe_lens_test_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  const std::filesystem::path file = folder / ("lens" + extension);
  std::ofstream(file, std::ios::binary) << text;
  LoadedLens loaded = load_said(file.string());
  std::filesystem::remove_all(folder);
  return loaded;
}

inline lens::System sound_lens_of(const std::string& text, const std::string& extension = ".json") {
  LoadedLens loaded = lens_of(text, extension);
  if (!loaded.system) throw Error(ErrorCode::scene, "lens", loaded.text());
  return *std::move(loaded.system);
}

/// Expects that a text is not a lens, with this message at this position.
inline LoadedLens unsound_lens_of(const std::string& text, const std::string& extension,
                                  const std::string& place, const std::string& message) {
  LoadedLens loaded = lens_of(text, extension);
  EXPECT_FALSE(loaded.system) << text;
  EXPECT_NE(loaded.text().find("lens" + extension + ":" + place), std::string::npos) << loaded.text();
  EXPECT_NE(loaded.text().find(message), std::string::npos) << loaded.text();
  return loaded;
}

/// Indices of the double Gauss at 587.6 nm: of N-SSK2, N-SK2, F5 and N-SK16.
using GaussIndices = std::array<double, 4>;
/// Indices as the listing states them.
inline constexpr GaussIndices kStatedIndices{1.622292, 1.607379, 1.603417, 1.620408};
/// Indices that round to these and reproduce the listed axial ray within its rounding. Six digits of the
/// indices leave that ray uncertain by 5e-5 mm.
inline constexpr GaussIndices kResolvedIndices{1.62229151, 1.60737891, 1.60341715, 1.62040786};

/// The double Gauss with these indices at every wavelength.
inline lens::System double_gauss_of(const GaussIndices& n) {
  lens::System system = lens_named("double_gauss");
  for (const auto& [surface, glass] : {std::pair(0, 0), {2, 1}, {3, 2}, {6, 2}, {7, 3}, {9, 3}})
    system.surfaces[static_cast<std::size_t>(surface)].behind->index =
        RefractiveIndex(n[static_cast<std::size_t>(glass)]);
  return system;
}

}  // namespace abbe::test
