#pragma once

#include <string>

namespace abbe {

/// Visibility of the symbols of a module and of the libraries that it links.
enum class ModuleScope {
  own,    ///< Other modules may not use them (RTLD_LOCAL).
  shared  ///< Other modules may use them (RTLD_GLOBAL).
};

/// Address of the function `name` that the module `module` exports, a file name such as "libx.so". Modules
/// are found along the program's run path (RUNPATH or LD_LIBRARY_PATH), opened at the first request and stay
/// open. Thread-safe. Throws Error{input}, calling the module `description`, if it is missing, does not load
/// or lacks the function.
[[nodiscard]] void* module_function(const char* module, const char* name, ModuleScope scope,
                                    const std::string& description);

/// The function table of a module, valid until the program ends. `name` is the exported function that returns
/// a `const Functions*`. Throws as `module_function`.
template <typename Functions>
[[nodiscard]] const Functions& module_functions(const char* module, const char* name, ModuleScope scope,
                                                const std::string& description) {
  return *reinterpret_cast<const Functions* (*)()>(module_function(module, name, scope, description))();
}

}  // namespace abbe
