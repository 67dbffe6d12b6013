#pragma once

#include <string>

namespace abbe {

/// SHA-256, in hexadecimal, of the build ids of all machine code that computes film values: this program,
/// Embree and the C mathematics library. Films of one scene have the same bits if it and `instruction_set`
/// are equal. Code without a build id does not contribute.
[[nodiscard]] std::string build_id();

/// The instruction set that the processor supports: "x86-64-v4" with AVX-512, else "x86-64-v3". Libraries may
/// select their code by it, so films have the same bits only if it is equal.
[[nodiscard]] std::string instruction_set();

}  // namespace abbe
