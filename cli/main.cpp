#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <new>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/answer.h"
#include "cli/commands.h"
#include "cli/crew.h"
#include "cli/usage.h"

namespace abbe::cli {
namespace {

// A reader that leaves must not end a render that only tells its progress. And a closed standard stream must
// not be the number of the next file opened: the stand-in gives an end of file or refuses what is written.
void prepare_streams() {
  // Writing fails then, and that is told.
  for (const int signal : {SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_IGN);
  for (const int stream : {0, 1, 2})
    if (::fcntl(stream, F_GETFD) < 0) (void)!::open("/dev/null", O_RDONLY);
}

// Whether standard output is a pipe that nobody reads any more.
bool reader_has_left() {
  pollfd output{STDOUT_FILENO, 0, 0};
  return ::poll(&output, 1, 0) == 1 && (output.revents & POLLERR) != 0;
}

int run(int argc, char** argv) {
  CLI::App app{"Abbe, a spectral renderer validated against measured colour science", "abbe"};
  Command command;
  add_commands(app, command);
  std::vector<std::string> arguments(argv + 1, argv + argc);
  // Some kinds are questions too, and CLI11 would take `--list camera` for the question.
  for (std::size_t i = 0; i + 1 < arguments.size(); ++i)
    if (arguments[i] == "--list" && !arguments[i + 1].starts_with('-')) {
      arguments[i] += '=' + arguments[i + 1];
      arguments.erase(arguments.begin() + static_cast<std::ptrdiff_t>(i) + 1);
    }
  if (arguments.empty()) arguments = {"help"};
  check_names(app, arguments);
  std::reverse(arguments.begin(), arguments.end());  // as CLI11 wants them
  try {
    app.parse(std::move(arguments));
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) return app.exit(e);
    throw Error(ErrorCode::usage, "", std::string(e.what()) + "\nRun abbe help for what is allowed.");
  }
  return command();
}

int guarded(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const Error& e) {
    say(e.what());
    return static_cast<int>(e.code);
  } catch (const std::bad_alloc&) {
    say("out of memory");
    return static_cast<int>(ErrorCode::resource);
  } catch (const std::exception& e) {
    if (std::ferror(stdout) != 0) return 0;  // of which main tells
    const auto* system = dynamic_cast<const std::system_error*>(&e);
    const bool no_threads = system != nullptr && system->code() == std::errc::resource_unavailable_try_again;
    say(fmt::format("{}: {}", no_threads ? "out of threads" : "internal error", e.what()));
    return static_cast<int>(no_threads ? ErrorCode::resource : ErrorCode::internal);
  }
}

}  // namespace
}  // namespace abbe::cli

int main(int argc, char** argv) {
  abbe::cli::prepare_streams();
  const int code = abbe::cli::guarded(argc, argv);
  if (code != 0) abbe::cli::abandon_crew(code);
  // An answer that did not reach its reader is no answer; but one who leaves, as `head` does, has read
  // enough.
  const bool told = std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && std::cout.flush();
  if (!told && !abbe::cli::reader_has_left()) {
    abbe::cli::say("cannot write to standard output");
    return static_cast<int>(abbe::ErrorCode::output);
  }
  return code;
}
