#include "description/table_ends.h"

#include "sensor/response/coverage.h"

namespace abbe::description {
namespace {

// Errors stand at each of their places.
void tell_once(const Diagnostics& found, LoadContext& context) {
  for (const Diagnostic& one : found.all())
    if (one.severity == Diagnostic::Severity::error)
      context.diagnostics.error(one.where, one.message, one.code);
    else if (context.ends.told.insert(one.message).second)
      context.diagnostics.warning(one.where, one.message);
}

}  // namespace

NamedCurve with_ends(NamedCurve table, const CurveUse& use, const SourcePosition& where, TableEnds& ends) {
  const bool covers = table.low_nm <= kMinWavelengthNm && table.high_nm >= kMaxWavelengthNm;
  const bool unknown = table.outside == Outside::error || (table.outside == Outside::zero && use.goes_on);
  if (covers || !unknown) return table;
  if (ends.noted != nullptr) ends.noted->push_back({table, where, ends.channel});
  if (ends.go_on) table.curve = held_beyond(table);
  return table;
}

LoadContext going_on(const LoadContext& context, Diagnostics& unheard) {
  LoadContext same{unheard, context.folder};
  same.unit_m = context.unit_m;
  same.ends.go_on = true;
  return same;
}

void check_ends(std::span<const EndedTable> tables, const Curve& light, std::span<const Channel> channels,
                LoadContext& context) {
  Diagnostics found;
  for (const auto& [table, where, own] : tables) {
    if (own.empty()) abbe::check_ends(table, light, channels, where, found);
    for (const Channel& channel : channels)
      if (channel.name == own) abbe::check_ends(table, light, {&channel, 1}, where, found);
  }
  tell_once(found, context);
}

}  // namespace abbe::description
