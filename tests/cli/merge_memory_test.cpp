#include <sys/resource.h>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/cli/program.h"
#include "tests/cli/scenes.h"
#include "transport/render/part.h"

// What `merge` holds of films that are far larger than the program.

namespace abbe::test {
namespace {

/// The parts of a render of one sample each, separated by blanks.
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

/// The most memory that the program had at a time when adding so many [bytes].
std::size_t peak_bytes(const FilmShape& shape, int count) {
  const std::string command =
      fmt::format("{} merge {} -o {} -o {} 2> {}", ABBE_BINARY, parts_of(shape, count), file("sum.abbepart"),
                  file("sum.exr"), file("stderr"));
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
  const std::size_t program = peak_bytes(small, 2);
  for (const int count : {2, 16, 64}) {
    const std::size_t peak = peak_bytes(large, count);
    RecordProperty(fmt::format("films_of_{}", count),
                   fmt::format("{:.2f}", static_cast<double>(peak - program) / static_cast<double>(film)));
    EXPECT_LE(peak, program + 3 * film + film / 4) << count;
  }
}

}  // namespace
}  // namespace abbe::test
