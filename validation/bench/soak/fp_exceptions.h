#pragma once

#include <string>

namespace abbe::soak {

/// Starts counting the floating-point exceptions (invalid, division by zero, overflow) of this thread and of
/// the threads that it starts, for the life of the process. The exceptions are unmasked, and the processor
/// steps over each.
/// Two kinds are not reported. Embree's tests of boxes and spheres rely on exceptions. Instructions on half
/// of a vector register have undefined values in the unused lanes; the compiler generates them for single
/// additions and products.
void watch_fp_exceptions();

/// Report of the exceptions so far, with one line per instruction: the count, the offset in its file and the
/// symbol, if known. Empty if there was none.
[[nodiscard]] std::string raised_fp_exceptions();

}  // namespace abbe::soak
