#include "cli/output_files.h"

#include <sys/stat.h>

#include <map>
#include <optional>
#include <system_error>

#include <fmt/format.h>

#include "cli/answer.h"
#include "io/atomic_file.h"
#include "io/data_directory.h"
#include "io/error.h"
#include "io/table.h"
#include "io/text.h"
#include "results/rendered_film.h"

namespace abbe::cli {
namespace {

namespace fs = std::filesystem;

// Device and inode of an existing file, with links resolved; the canonical path of a file that does not
// exist.
std::string identity_of(const fs::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) == 0) return fmt::format("{}:{}", status.st_dev, status.st_ino);
  return weakly_canonical(absolute(destination(file))).string();
}

[[noreturn]] void refuse(const fs::path& output, const fs::path& other, std::string_view why) {
  throw Error(ErrorCode::usage, output.string(),
              fmt::format("is the same file as {}{}", other.string(), why));
}

}  // namespace

void require_film_output(const fs::path& path) {
  require_extension(path, {".exr", kPartExtension});
  require_writable(path);
}

void require_picture_extension(const fs::path& path) {
  require_extension(path, {".png", ".jpg", ".tif"});
}

void require_no_view(const ViewOptions& view, std::string_view pictures) {
  const char* option = !view.view.empty()      ? "--view"
                       : !view.display.empty() ? "--screen"
                       : !view.config.empty()  ? "--ocio"
                                               : "";
  if (*option != 0)
    throw Error(ErrorCode::usage, option,
                fmt::format("applies to pictures only (allowed with {})", pictures));
}

void require_distinct(std::span<const fs::path> outputs, std::span<const fs::path> inputs) {
  constexpr std::string_view kIsRead = ", which is an input: choose another output file";
  std::map<std::string, fs::path> written;
  bool replaces = false;
  for (const fs::path& output : outputs) {
    if (output.empty()) continue;
    const auto [earlier, added] = written.emplace(identity_of(output), output);
    if (!added) refuse(output, earlier->second, ": choose a different file for each output");
    std::error_code ignored;
    replaces = replaces || fs::exists(output, ignored);
  }
  const auto guard = [&written, kIsRead](const fs::path& input) {
    const auto output = written.find(identity_of(input));
    if (output != written.end()) refuse(output->second, input, kIsRead);
  };
  for (const fs::path& input : inputs)
    if (!input.empty()) guard(input);
  if (replaces)
    for (const fs::path& table : data_tables()) guard(table);
}

std::vector<fs::path> writable_among(std::span<const fs::path> outputs) {
  std::vector<fs::path> writable;
  std::optional<Error> failure;
  for (const fs::path& output : outputs) try {
      require_writable(output);
      writable.push_back(output);
    } catch (const Error& error) {
      if (!failure) failure = error;
    }
  if (failure && writable.empty()) throw *failure;
  return writable;
}

void write_all(std::span<const std::function<void()>> writers) {
  std::optional<Error> failure;
  for (const auto& write : writers) try {
      write();
    } catch (const Error& error) {
      if (failure)
        print_message(error.what());
      else
        failure = error;
    }
  if (failure) throw *failure;
}

std::vector<fs::path> files_among(std::initializer_list<std::string> names) {
  std::vector<fs::path> files;
  for (const std::string& name : names) {
    const fs::path path = name.substr(0, user_table_end(name));
    std::error_code ignored;
    if (fs::is_regular_file(path, ignored)) files.push_back(path);
  }
  return files;
}

}  // namespace abbe::cli
