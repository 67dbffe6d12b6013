#include "io/module.h"

#include <dlfcn.h>

#include "io/error.h"

namespace abbe {

void* module_function(const char* module, const char* name, ModuleScope scope,
                      const std::string& description) {
  const int flags = scope == ModuleScope::shared ? RTLD_NOW | RTLD_GLOBAL : RTLD_LAZY | RTLD_LOCAL;
  void* opened = dlopen(module, flags);
  void* function = opened != nullptr ? dlsym(opened, name) : nullptr;
  if (function == nullptr) throw Error(ErrorCode::input, description + " does not load", dlerror());
  return function;
}

}  // namespace abbe
