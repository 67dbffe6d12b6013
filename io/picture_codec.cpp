#include "io/picture_codec.h"

#include <dlfcn.h>

#include "io/error.h"

namespace abbe {
namespace {

const PictureCodec* open_module() {
  void* module = dlopen(ABBE_PICTURE_MODULE, RTLD_LAZY | RTLD_LOCAL);
  void* symbol = module != nullptr ? dlsym(module, kPictureCodecSymbol) : nullptr;
  if (symbol == nullptr)
    throw Error(ErrorCode::input, "the module that reads and writes pictures does not load", dlerror());
  return reinterpret_cast<const PictureCodec* (*)()>(symbol)();
}

}  // namespace

const PictureCodec& picture_codec() {
  static const PictureCodec* codec = open_module();
  return *codec;
}

}  // namespace abbe
