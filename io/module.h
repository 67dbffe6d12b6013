#pragma once

#include <string>

namespace abbe {

/// `shared`: other modules may use the symbols of the libraries that the module links (RTLD_GLOBAL); `own`:
/// they may not (RTLD_LOCAL).
enum class ModuleScope { own, shared };

/// Address of the function `name` that a module exports. Modules are shared libraries that few commands need
/// or few machines have. A module is opened when its first function is requested. It is found along the
/// program's run path (RUNPATH or LD_LIBRARY_PATH). Throws Error{input}, calling the module `description`, if
/// it is missing or does not load.
[[nodiscard]] void* module_function(const char* module, const char* name, ModuleScope scope,
                                    const std::string& description);

/// The function table of a module. `name` is the exported function that returns a `const Functions*`.
template <typename Functions>
[[nodiscard]] const Functions& module_functions(const char* module, const char* name, ModuleScope scope,
                                                const std::string& description) {
  return *reinterpret_cast<const Functions* (*)()>(module_function(module, name, scope, description))();
}

}  // namespace abbe
