#pragma once

#include <string>

namespace abbe {

/// A hash of the build ids of all machine code that computes film values: this program, Embree and the C
/// mathematics library. Films of one scene have the same bits if it and `instruction_set` are equal.
[[nodiscard]] std::string build_id();

/// The instruction set that the processor supports, by which Embree selects its code: "x86-64-v4" or
/// "x86-64-v3".
[[nodiscard]] std::string instruction_set();

}  // namespace abbe
