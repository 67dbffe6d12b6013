#pragma once

#include <string>

namespace abbe::soak {

/// Starts counting the floating-point exceptions (invalid, division by zero, overflow) of this thread and of
/// the threads that it starts, for the life of the process. The exceptions are unmasked, and the processor
/// steps over each. A thread is watched up to its 1,000th exception and all threads together up to about
/// 100,000, so the counts are lower bounds.
/// Two kinds are not reported. Embree's tests of boxes and spheres rely on exceptions. Instructions on half
/// of a vector register have undefined values in the unused lanes; the compiler generates them for single
/// additions and products.
void watch_fp_exceptions();

/// Report of the exceptions since `watch_fp_exceptions`, with one line per instruction: kind, offset in its
/// file, symbol if known, and count. At most 512 instructions are recorded. Empty if there was none.
[[nodiscard]] std::string raised_fp_exceptions();

}  // namespace abbe::soak
