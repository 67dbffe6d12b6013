#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <nlohmann/json.hpp>

/// Path of the program under test for shells: the one of the build to which this test program belongs, next
/// to its folder `tests`. It is found at run time, so that objects do not depend on the folder of the build.
#define ABBE_BINARY "\"$ABBE_BINARY\""

namespace abbe::test {

inline const int kShellsKnowTheProgram =
    setenv("ABBE_BINARY",
           (std::filesystem::canonical("/proc/self/exe").parent_path() / "../../cli/abbe")
               .lexically_normal()
               .c_str(),
           1);

/// Result of a run of the program.
struct Outcome {
  int code;
  std::string out;
  std::string err;

  [[nodiscard]] nlohmann::json json() const { return nlohmann::json::parse(out); }
};

inline std::string read_file(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// A folder that belongs to this process. It is emptied first and removed at the end.
class Scratch {
 public:
  Scratch() : path_(std::filesystem::temp_directory_path() / ("abbe_cli_test_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~Scratch() { std::filesystem::remove_all(path_); }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  [[nodiscard]] std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

inline const Scratch& scratch() {
  static const Scratch folder;
  return folder;
}

/// Runs a shell command.
inline Outcome shell(const std::string& command) {
  const std::filesystem::path err = scratch() / "stderr";
  Outcome run{};
  FILE* pipe = popen(("{ " + command + "\n} 2>" + err.string()).c_str(), "r");
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) run.out += static_cast<char>(c);
  const int status = pclose(pipe);
  run.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  run.err = read_file(err);
  return run;
}

/// Runs the program in a shell with these arguments.
inline Outcome abbe(const std::string& arguments) {
  return shell(ABBE_BINARY " " + arguments);
}

}  // namespace abbe::test
