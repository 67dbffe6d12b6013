#include "description/scene.h"

namespace abbe::spec {

using namespace schema;

static const Fields& fields(Tag<Output>) {
  static const Fields kFields = describe<Output>(
      "output", "What is written, relative to the working directory.",
      {field("image", &Output::image, text(), "The film as an EXR file."),
       field("display", &Output::display, text(), "The picture as a PNG, JPEG or TIFF file."),
       field("exposure", &Output::exposure, number({0, 1e30, true, false}),
             "Film value shown as diffuse white, chosen from the image when absent."),
       field("white", &Output::white, white(),
             "What is shown as white: the name of a light, else of an illuminant or its file, or "
             "chromaticity coordinates [x, y]; "
             "the light that exposes the film most when absent.")});
  return kFields;
}

const Fields& fields(Tag<Scene>) {
  static const Fields kFields = describe<Scene>(
      "Abbe scene", "Lengths are in `units`, wavelengths in nm.",
      {field("$schema", &Scene::schema, text(), "Where editors find this schema."),
       field("abbe", &Scene::version, number({kFormatVersion, kFormatVersion}),
             "Version of the scene format."),
       field("units", &Scene::units, word<Unit>("unit of length", {"m", "cm", "mm", "um", "in"}),
             "Unit of length.")
           .or_default(),
       field("camera", &Scene::camera, thing<Camera>(), "The camera.").required(),
       field("sensor", &Scene::sensor, thing<Sensor>(), "The sensor.").required(),
       field("materials", &Scene::materials, materials(), "Materials by name.").or_default(),
       field("objects", &Scene::objects, objects(), "Shapes by name, for instances to place.").or_default(),
       field("shapes", &Scene::shapes, shapes(), "What is there.").or_default(),
       field("lights", &Scene::lights, lights(), "What shines.").or_default(),
       field("render", &Scene::render, thing<Render>(), "How to render."),
       field("output", &Scene::output, thing<Output>(), "What is written.")});
  return kFields;
}

}  // namespace abbe::spec
