#include "cli/output_files.h"

#include <sys/stat.h>

#include <map>
#include <optional>
#include <system_error>

#include <fmt/format.h>

#include "cli/answer.h"
#include "film/rendered_film.h"
#include "io/atomic_file.h"
#include "io/data_directory.h"
#include "io/error.h"
#include "io/extension.h"
#include "io/table.h"

namespace abbe::cli {
namespace {

namespace fs = std::filesystem;

// Device and inode of a file that is there, wherever links lead; the place of one that is not.
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
  const char* unmet = !view.view.empty()      ? "--view"
                      : !view.display.empty() ? "--screen"
                      : !view.config.empty()  ? "--ocio"
                                              : "";
  if (*unmet != 0)
    throw Error(ErrorCode::usage, unmet, fmt::format("only a picture takes it (allowed with {})", pictures));
}

void require_distinct(std::span<const fs::path> outputs, std::span<const fs::path> inputs) {
  constexpr std::string_view kIsRead = ", which is read: an output needs a place of its own";
  std::map<std::string, fs::path> written;
  bool replaces = false;
  for (const fs::path& output : outputs) {
    if (output.empty()) continue;
    const auto [there, added] = written.emplace(identity_of(output), output);
    if (!added) refuse(output, there->second, ": each output needs a place of its own");
    std::error_code ignored;
    replaces = replaces || fs::exists(output, ignored);
  }
  const auto guard = [&written, kIsRead](const fs::path& input) {
    const auto found = written.find(identity_of(input));
    if (found != written.end()) refuse(found->second, input, kIsRead);
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
        say(error.what());
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
