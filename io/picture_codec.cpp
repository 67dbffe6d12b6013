#include "io/picture_codec.h"

#include "io/module.h"

namespace abbe {

const PictureCodec& picture_codec() {
  static const PictureCodec& codec =
      module_functions<PictureCodec>(ABBE_PICTURE_MODULE, kPictureCodecSymbol, ModuleScope::own,
                                     "the module that reads and writes pictures");
  return codec;
}

}  // namespace abbe
