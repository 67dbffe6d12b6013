#include "description/load_context.h"

#include <algorithm>
#include <system_error>

#include <fmt/format.h>

#include "io/data_directory.h"
#include "io/table.h"
#include "materials/index/library.h"
#include "sensor/response/table_range.h"

namespace abbe::description {
namespace {

// Reports errors at each of their positions, and each warning once.
void report_once(const Diagnostics& faults, LoadContext& context) {
  for (const Diagnostic& fault : faults.all())
    if (fault.severity == Diagnostic::Severity::error)
      context.diagnostics.error(fault.where, fault.message, fault.code);
    else if (context.coverage.warned.insert(fault.message).second)
      context.diagnostics.warning(fault.where, fault.message);
}

}  // namespace

std::optional<std::filesystem::path> LoadContext::file(const std::string& name, const SourcePosition& where) {
  if (name.find("://") != std::string::npos) {
    diagnostics.error(where, fmt::format("expected a file (got the URL \"{}\")", name), ErrorCode::input);
    return std::nullopt;
  }
  remember(folder / name);
  return files.back();
}

void LoadContext::remember(const std::filesystem::path& file) {
  files.push_back(file);
  if (inputs != nullptr) inputs->add_file(file);
}

void LoadContext::take_memory(const std::string& what, std::size_t bytes) const {
  if (inputs != nullptr) inputs->reserve_memory(what, bytes);
}

std::optional<std::string> LoadContext::table(const std::string& name, const SourcePosition& where) {
  const std::size_t end = user_table_end(name);  // A column name may follow the file name.
  if (end == std::string::npos && !name.ends_with(".json") && !is_refractiveindex_info(name)) return name;
  const auto path = file(name.substr(0, end), where);
  if (!path) return std::nullopt;
  return path->string() + name.substr(std::min(end, name.size()));
}

std::vector<std::string> shipped_names(const char* folder) {
  std::vector<std::string> names;
  std::error_code missing;
  for (const auto& entry : std::filesystem::directory_iterator(data_directory() / folder, missing))
    if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
  std::ranges::sort(names);
  return names;
}

NamedCurve with_extrapolation(NamedCurve table, const CurveUse& use, const SourcePosition& where,
                              TableCoverage& coverage) {
  const bool covers = table.low_nm <= kMinWavelengthNm && table.high_nm >= kMaxWavelengthNm;
  const bool must_note =
      table.outside == Outside::error || (table.outside == Outside::zero && use.extrapolates_constant);
  if (covers || !must_note) return table;
  if (coverage.partial_tables != nullptr)
    coverage.partial_tables->push_back({table, where, coverage.channel});
  if (coverage.extrapolate) table.curve = extrapolated(table);
  return table;
}

LoadContext extrapolating_context(const LoadContext& context, Diagnostics& discarded) {
  LoadContext copy{discarded, context.folder};
  copy.unit_m = context.unit_m;
  copy.coverage.extrapolate = true;
  return copy;
}

void check_table_range(std::span<const PartialTable> tables, const Curve& light,
                       std::span<const Channel> channels, LoadContext& context) {
  Diagnostics faults;
  for (const auto& [table, where, channel_name] : tables) {
    if (channel_name.empty()) abbe::check_table_range(table, light, named_responses(channels), where, faults);
    for (const Channel& channel : channels)
      if (channel.name == channel_name)
        abbe::check_table_range(table, light, named_responses({&channel, 1}), where, faults);
  }
  report_once(faults, context);
}

}  // namespace abbe::description
