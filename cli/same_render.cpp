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

// All that decides which passes are traced, by whom, and what their sums are of.
std::string described(const FilmIdentity& identity, const abbe::RenderOptions& how,
                      const std::optional<RenderResult>& start) {
  FilmIdentity all = told_apart_by(identity);
  if (const auto stated = identity.find(kStatedSamplesKey); stated != identity.end()) all.insert(*stated);
  std::string text;
  for (const auto& [key, value] : all) text += fmt::format("{}: {}\n", key, value);
  text += fmt::format("range {}\ntime {}\nerror {}\n", text_of(how.samples), text_of(how.time_limit_s),
                      text_of(how.target_error));
  if (!start) return text;
  text += fmt::format("start {}\n", to_text(start->samples));
  if (const auto& begun = start->unfinished)
    text += fmt::format("begun {} {}\n", text_of(begun->samples), begun->items);
  return text;
}

}  // namespace

void require_same_render(const Crew& crew, const FilmIdentity& identity, const abbe::RenderOptions& how,
                         const std::optional<RenderResult>& start) {
  if (crew.size == 1) return;
  constexpr std::size_t kDigits = 16;  // of a 64-bit number
  const std::string hash = sha256(described(identity, how, start)).substr(0, kDigits);
  const std::uint64_t own = std::stoull(hash, nullptr, 16);
  if (crew.follow(own) == own) return;
  throw Error(ErrorCode::input, "mpirun",
              fmt::format("process {} renders something else than the first: give all of them one command "
                          "line, the same files and build, and processors of one instruction set",
                          crew.rank));
}

}  // namespace abbe::cli
