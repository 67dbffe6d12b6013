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
#include "cli/mpi_group.h"

namespace abbe::cli {
namespace {

// Ignores the signals of failed writes, so that a closed pipe does not end a render that reports its
// progress. Opens /dev/null for closed standard streams, since the next opened file would get their numbers.
// Reading it gives the end of the file, and writing fails.
void prepare_streams() {
  // Failed writes are reported at the end.
  for (const int signal : {SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_IGN);
  for (const int stream : {0, 1, 2})
    if (::fcntl(stream, F_GETFD) < 0) (void)!::open("/dev/null", O_RDONLY);
}

// True if standard output is a pipe whose reader has closed it.
bool reader_has_closed() {
  pollfd output{STDOUT_FILENO, 0, 0};
  return ::poll(&output, 1, 0) == 1 && (output.revents & POLLERR) != 0;
}

// Parses the command line and runs the chosen command.
int run(int argc, char** argv) {
  CLI::App app{"Abbe, a spectral renderer validated against measured colour science", "abbe"};
  Command command;
  add_commands(app, command);
  std::vector<std::string> arguments(argv + 1, argv + argc);
  // Some kinds are also names of queries, and CLI11 would take `--list camera` for the query.
  for (std::size_t i = 0; i + 1 < arguments.size(); ++i)
    if (arguments[i] == "--list" && !arguments[i + 1].starts_with('-')) {
      arguments[i] += '=' + arguments[i + 1];
      arguments.erase(arguments.begin() + static_cast<std::ptrdiff_t>(i) + 1);
    }
  if (arguments.empty()) arguments = {"help"};
  check_names(app, arguments);
  std::ranges::reverse(arguments);  // the order that CLI11 expects
  try {
    app.parse(std::move(arguments));
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) return app.exit(e);
    throw Error(ErrorCode::usage, "", std::string(e.what()) + "\nRun abbe help for what is allowed.");
  }
  return command();
}

// Exit code of `run`; prints exceptions to stderr.
int guarded(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const Error& e) {
    print_message(e.what());
    return static_cast<int>(e.code);
  } catch (const std::bad_alloc&) {
    print_message("out of memory");
    return static_cast<int>(ErrorCode::resource);
  } catch (const std::exception& e) {
    if (std::ferror(stdout) != 0) return 0;  // reported by main
    const auto* system = dynamic_cast<const std::system_error*>(&e);
    const bool out_of_threads =
        system != nullptr && system->code() == std::errc::resource_unavailable_try_again;
    print_message(fmt::format("{}: {}", out_of_threads ? "out of threads" : "internal error", e.what()));
    return static_cast<int>(out_of_threads ? ErrorCode::resource : ErrorCode::internal);
  }
}

}  // namespace
}  // namespace abbe::cli

int main(int argc, char** argv) {
  abbe::cli::prepare_streams();
  const int code = abbe::cli::guarded(argc, argv);
  if (code != 0) abbe::cli::abort_mpi_group(code);
  // An answer that could not be written is an error, unless the reader closed the pipe early, as `head` does.
  const bool is_written = std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && std::cout.flush();
  if (!is_written && !abbe::cli::reader_has_closed()) {
    abbe::cli::print_message("cannot write to standard output");
    return static_cast<int>(abbe::ErrorCode::output);
  }
  return code;
}
