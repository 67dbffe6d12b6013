#include "cli/same_render.h"

#include <cstddef>
#include <cstdint>
#include <string>

#include <fmt/format.h>

#include "io/error.h"
#include "io/text.h"
#include "transport/render/sample_ranges.h"

namespace abbe::cli {
namespace {

std::string text_of(const std::optional<double>& number) {
  return number ? fmt::format("{}", *number) : "none";
}

std::string text_of(const std::optional<SampleRange>& range) {
  return range ? to_text(SampleRanges{*range}) : "none";
}

// Everything that determines which passes are traced by which process, and the meaning of their sums.
std::string render_description(const FilmIdentity& identity, const abbe::RenderOptions& render_options,
                               const std::optional<RenderResult>& start) {
  FilmIdentity all = distinguishing_keys(identity);
  if (const auto stated = identity.find(kStatedSamplesKey); stated != identity.end()) all.insert(*stated);
  std::string text;
  for (const auto& [key, value] : all) text += fmt::format("{}: {}\n", key, value);
  text += fmt::format("range {}\ntime {}\nerror {}\n", text_of(render_options.samples),
                      text_of(render_options.time_limit_s), text_of(render_options.target_error));
  if (!start) return text;
  text += fmt::format("start {}\n", to_text(start->samples));
  if (const auto& begun = start->unfinished)
    text += fmt::format("begun {} {}\n", text_of(begun->samples), begun->items);
  return text;
}

}  // namespace

void require_same_render(const MpiGroup& mpi_group, const FilmIdentity& identity,
                         const abbe::RenderOptions& render_options,
                         const std::optional<RenderResult>& start) {
  if (mpi_group.size == 1) return;
  constexpr std::size_t kDigits = 16;  // hexadecimal, of 64 bits
  const std::string hash = sha256(render_description(identity, render_options, start)).substr(0, kDigits);
  const std::uint64_t own_hash = std::stoull(hash, nullptr, 16);
  if (mpi_group.broadcast(own_hash) == own_hash) return;
  throw Error(ErrorCode::input, "mpirun",
              fmt::format("process {} does not render the same film as the root process: give all processes "
                          "the same command line, files, build and instruction set of the processor",
                          mpi_group.rank));
}

}  // namespace abbe::cli
