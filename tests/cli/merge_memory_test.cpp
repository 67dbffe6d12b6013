#include <sys/resource.h>

#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/cli/program.h"
#include "tests/cli/scenes.h"
#include "tests/tier.h"
#include "transport/render/part.h"

// Memory of `merge` for films that are far larger than the program.

namespace abbe::test {
namespace {

/// Parts of a render with one sample each, separated by blanks.
std::string parts_of(const FilmShape& shape, int count) {
  std::string names;
  RenderResult result{Film(shape), {}, {}};
  const FilmIdentity identity{{"sensor_channels", "Y"}, {kStatedSamplesKey, fmt::format("{}", count)}};
  for (int i = 0; i < count; ++i) {
    const auto first = static_cast<std::uint64_t>(i);
    const std::string name = file(fmt::format("{}-{}.abbepart", shape.width, i));
    result.samples = {{first, first + 1}};
    write_part(name, identity, result);
    names += name + " ";
  }
  return names;
}

/// Parts of a render with two samples: this number of crops, with a part per sample and crop.
std::string crop_parts_of(FilmShape shape, int count) {
  std::string names;
  for (int i = 0; i < 2 * count; ++i) {
    const int row = i / 2;
    shape.crop = Crop{0, row * shape.height / count, shape.width, (row + 1) * shape.height / count};
    const auto first = static_cast<std::uint64_t>(i % 2);
    const RenderResult result{Film(shape), {{first, first + 1}}, {}};
    const std::string name = file(fmt::format("crop-{}-{}.abbepart", shape.width, i));
    write_part(name, {{"sensor_channels", "Y"}, {kStatedSamplesKey, "2"}, {kCropKey, to_text(*shape.crop)}},
               result);
    names += name + " ";
  }
  return names;
}

/// Maximum memory of the program while it merges them [bytes].
std::size_t peak_bytes(const std::string& parts) {
  const std::string command = fmt::format("{} merge {} -o {} -o {} 2> {}", ABBE_BINARY, parts,
                                          file("sum.abbepart"), file("sum.exr"), file("stderr"));
  const pid_t child = fork();
  if (child == 0) {
    execl("/bin/sh", "sh", "-c", ("exec " + command).c_str(), nullptr);
    _exit(127);
  }
  int status = 0;
  rusage usage{};
  EXPECT_EQ(wait4(child, &status, 0, &usage), child);
  EXPECT_EQ(status, 0) << read_file(file("stderr"));
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

TEST(MergeMemory, IsThreeFilmsWhateverTheNumberOfParts) {
  const FilmShape small{16, 16, 1, 2, -77};
  const FilmShape large{512, 512, 1, 2, -77};
  const std::size_t film = Film(large).memory_bytes();
  const std::size_t program = peak_bytes(parts_of(small, 2));
  const auto films = [&](const std::string& parts) {
    return static_cast<double>(peak_bytes(parts) - program) / static_cast<double>(film);
  };
  const std::vector<int> counts = nightly() ? std::vector{2, 16, 64} : std::vector{2, 12};
  for (const int count : counts) {
    const double held = films(parts_of(large, count));
    RecordProperty(fmt::format("films_of_{}", count), fmt::format("{:.2f}", held));
    EXPECT_LE(held, 3.25) << count;
  }
  // Two of these are a crop and its bytes.
  for (const int count : counts) {
    const double held = films(crop_parts_of(large, count));
    RecordProperty(fmt::format("films_of_{}_crops", count), fmt::format("{:.2f}", held));
    EXPECT_LE(held, 1.25 + 2.0 / count) << count;
  }
}

}  // namespace
}  // namespace abbe::test
