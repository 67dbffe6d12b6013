#pragma once

#include <string>

namespace abbe {

/// Whether what a module links is there for other modules too.
enum class ModuleScope { own, shared };

/// A function that a module of the program exports. Modules are shared libraries that few commands need, or
/// few machines have; one is opened when its first function is asked for, found along the program's run path
/// (RUNPATH, or LD_LIBRARY_PATH). Throws Error{input} naming what the module is, as `is`, when it is not
/// there or does not load.
[[nodiscard]] void* module_function(const char* module, const char* name, ModuleScope scope,
                                    const std::string& is);

/// What a module offers: `name` is the function of it that returns a `const Functions*`.
template <typename Functions>
[[nodiscard]] const Functions& module_functions(const char* module, const char* name, ModuleScope scope,
                                                const std::string& is) {
  return *reinterpret_cast<const Functions* (*)()>(module_function(module, name, scope, is))();
}

}  // namespace abbe
