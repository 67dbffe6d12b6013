#pragma once

#include <string>

namespace abbe {

/// A hash of the build ids of all machine code that film values come from: of this program, of Embree and of
/// the C library's mathematics. Films of one scene have the same bits if it and `instruction_set` are equal.
[[nodiscard]] std::string build_id();

/// What the processor offers beyond what the program is compiled for, by which Embree chooses among its own:
/// "x86-64-v4" or "x86-64-v3".
[[nodiscard]] std::string instruction_set();

}  // namespace abbe
