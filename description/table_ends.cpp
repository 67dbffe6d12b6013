#include "description/table_ends.h"

#include <algorithm>
#include <iterator>
#include <vector>

#include "sensor/response/coverage.h"

namespace abbe::description {

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

void check_ends(std::span<const EndedTable> tables, std::span<const Channel> channels,
                Diagnostics& diagnostics) {
  for (const EndedTable& ended : tables) {
    std::vector<Channel> own;
    std::copy_if(channels.begin(), channels.end(), std::back_inserter(own), [&](const Channel& channel) {
      return ended.channel.empty() || channel.name == ended.channel;
    });
    abbe::check_ends(ended.table, own, ended.where, diagnostics);
  }
}

}  // namespace abbe::description
