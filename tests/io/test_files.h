#pragma once

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>

#include "io/json.h"

namespace abbe {

/// A folder of the running test's own, emptied first.
inline std::filesystem::path test_folder() {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "abbe_io_test" /
                                       (std::string(test->test_suite_name()) + "." + test->name());
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

inline void put(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

inline std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline std::shared_ptr<const SourceText> source(std::string text) {
  return std::make_shared<SourceText>(SourceText{"a.json", std::move(text)});
}

/// What reading `text` as JSON complains about; "" when it is fine.
inline std::string complaint(const std::string& text) {
  Diagnostics diagnostics;
  const auto value = parse_json(source(text), diagnostics);
  EXPECT_EQ(value.has_value(), !diagnostics.has_errors());
  return diagnostics.text();
}

/// Writes with `write` on a disk that is full after `bytes`, and exits with the code of the error thrown, or
/// 0.
template <class Write>
void write_on_full_disk(std::size_t bytes, Write write) {
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{bytes, bytes};
  ::setrlimit(RLIMIT_FSIZE, &limit);
  try {
    write();
  } catch (const Error& error) {
    std::exit(static_cast<int>(error.code));
  }
  std::exit(0);
}

}  // namespace abbe
