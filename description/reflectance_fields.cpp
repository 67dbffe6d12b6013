#include "description/reflectance.h"

namespace abbe {

static const schema::Fields& fields(schema::Tag<TextureMapping>) {
  using namespace schema;
  constexpr Range kMapping{-1e6, 1e6};
  static const Fields kFields = describe<TextureMapping>(
      "texture_mapping", "",
      {field("filter", &TextureMapping::filter, word<TextureFilter>("filter", {"bilinear", "nearest"}),
             "What holds between the centres of texels.")
           .or_default(),
       field("wrap", &TextureMapping::wrap, word<TextureWrap>("wrap", {"repeat", "clamp"}),
             "What holds beyond the edges of the image.")
           .or_default(),
       field("scale", &TextureMapping::scale, schema::vector<Imath::V2d>(kMapping),
             "The image lies at scale * (u, v) + offset.")
           .or_default(),
       field("offset", &TextureMapping::offset, schema::vector<Imath::V2d>(kMapping),
             "The image lies at scale * (u, v) + offset.")
           .or_default()});
  return kFields;
}

namespace spec {

using namespace schema;

const Fields& fields(Tag<TextureFile>) {
  static const Fields kFields = describe<TextureFile>(
      "texture_file", "",
      {field("image", &TextureFile::image, text(), "EXR, PNG, TIFF or another file that OpenImageIO reads."),
       lent(&TextureFile::mapping)});
  return kFields;
}

static const Fields& fields(Tag<Texture>) {
  static const Fields kFields = describe<Texture>(
      "texture", "An image whose channels weigh spectra.",
      {lent(&Texture::file),
       one_of(
           &Texture::of,
           under<Weights>("weights", by_name<Curve>(curve(), "spectra by channel", 1),
                          "The spectrum that each channel weighs; values are taken as linear."),
           under<Rgb>(
               "rgb", boolean(),
               "true: channels R, G, B are a colour, sRGB in files of integers, linear in .exr and .hdr."))});
  return kFields;
}

Kind reflectance() {
  return forms<Reflectance>("reflectance", "a reflectance",
                            form<Texture>(Json::object, thing<Texture>(), {"image"}),
                            form<Curve>(Json::any, curve()));
}

}  // namespace spec
}  // namespace abbe
