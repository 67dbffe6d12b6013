#pragma once

#include <string>

namespace abbe::soak {

/// Counts, from now on, the floating-point exceptions (invalid, division by zero, overflow) that this thread
/// and those it starts raise, for the life of the process: by unmasking them and letting the processor step
/// over each. Those within Embree do not count, since its tests of boxes and balls rely on them; nor do those
/// of instructions on half of a vector register, whose unused lanes hold what is no number: the compiler
/// makes such of single additions and products.
void watch_traps();

/// What was raised, one line for each instruction with how often, an offset into its file, and the symbol if
/// it has one; empty when nothing was.
[[nodiscard]] std::string traps_seen();

}  // namespace abbe::soak
