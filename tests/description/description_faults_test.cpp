#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "description.h"

namespace abbe {
namespace {

using DescriptionFaultsTest = test::DescriptionTest;
using test::Fault;
using test::lit;
using test::Loaded;
using test::painted;
using test::sensed;
using test::shaped;

TEST_F(DescriptionFaultsTest, RefusesAndExplainsWhatIsWrong) {
  const std::string unit = R"("sphere": {"center": [0, 0, 0], "radius": 1})";
  const std::string at = R"("from": [0, -3, 0], "to": [0, 0, 0], "up": [0, 0, 1]})";
  const std::vector<Fault> faults{
      {"1 truncated", R"({"abbe": 1, "camera": {)", ErrorCode::scene, "got the end of the text"},
      {"2 empty", "", ErrorCode::scene, "expected a value (got an empty text)"},
      {"3 trailing bytes", R"({"abbe": 1} x)", ErrorCode::scene, "expected the end of the text (got x)"},
      {"3 NUL", std::string("{\"abbe\": 1}\0", 12), ErrorCode::scene, "NUL byte"},
      {"4 duplicate key", R"({"abbe": 1, "abbe": 1})", ErrorCode::scene, "duplicate key \"abbe\""},
      {"5 another type", R"({"shapes": [{"mesh": 5}]})", ErrorCode::scene,
       "expected a mesh: the name of a file, or triangles (got a number)"},
      {"5 two strengths at once",
       R"({"lights": [{"sun": {"towards": [0, 0, 1], "illuminance": 1}, "emission": {"blackbody_K": 5000}}]})",
       ErrorCode::scene, "sun/illuminance: error: cannot be combined with \"emission\""},
      {"5 unknown key", R"({"render": {"smaples": 4}})", ErrorCode::scene,
       "/render/smaples: error: unknown key \"smaples\"; did you mean \"samples\"?"},
      {"6 wrong type", R"({"render": {"samples": "many"}})", ErrorCode::scene,
       "/render/samples: error: expected an integer (got \"many\", allowed [1, 16777216])"},
      {"6 wrong type", R"({"shapes": {}})", ErrorCode::scene, "expected an array of shapes (got an object)"},
      {"7 NaN", R"({"render": {"samples": NaN}})", ErrorCode::scene, "(got NaN, allowed finite numbers)"},
      {"7 infinity", R"({"render": {"samples": -Infinity}})", ErrorCode::scene,
       "(got -Infinity, allowed finite numbers)"},
      {"7 beyond double", R"({"render": {"samples": 1e400}})", ErrorCode::scene,
       "number out of range (got 1e400"},
      {"8 beyond float", shaped(R"("sphere": {"center": [0, 0, 0], "radius": 1e300})"), ErrorCode::scene,
       "/shapes/0/sphere/radius: error: expected a number (got 1e+300, allowed (0, 1000000000000])"},
      {"9 negative count", R"({"render": {"samples": -1}})", ErrorCode::scene,
       "(got -1, allowed [1, 16777216])"},
      {"9 endless paths", R"({"render": {"roulette_depth": -1}})", ErrorCode::scene,
       "/render/roulette_depth: error: never ends a path, and then max_depth is required (got -1 without a "
       "max_depth)"},
      {"9 fractional count", R"({"render": {"samples": 1.5}})", ErrorCode::scene,
       "expected an integer (got 1.5"},
      {"10 deep nesting", std::string(1000000, '['), ErrorCode::scene,
       "nesting too deep (allowed 256 levels)"},
      {"11 bad UTF-8", "{\"abbe\": \"\xff\"}", ErrorCode::scene, "invalid UTF-8 (got byte 0xFF)"},
      {"12 dangling name",
       R"({"materials": {"glass": {"diffuse": {"reflectance": 0}}}, "shapes": [{)" + unit +
           R"(, "material": "galss"}]})",
       ErrorCode::scene, "/shapes/0/material: error: unknown material \"galss\"; did you mean \"glass\"?"},
      {"13 no includes, so no cycles", R"({"include": "scene.json"})", ErrorCode::scene,
       "unknown key \"include\""},
      {"16 no pixels", sensed(R"("resolution": [0, 4], "observer": "1931")"), ErrorCode::scene,
       "/sensor/resolution/0: error: expected an integer (got 0, allowed [1, inf))"},
      {"16 negative", sensed(R"("resolution": [4, -5], "observer": "1931")"), ErrorCode::scene,
       "(got -5, allowed"},
      {"16 too many pixels", sensed(R"("resolution": [1e6, 1e6], "observer": "1931")"), ErrorCode::resource,
       "too many pixels (got 1000000 x 1000000, allowed edges up to 65536 and 268435456 pixels in all)"},
      {"16 too many pixels", sensed(R"("resolution": [65536, 65536], "observer": "1931")"),
       ErrorCode::resource, "too many pixels"},
      {"17 no samples", R"({"render": {"samples": 0}})", ErrorCode::scene, "(got 0, allowed [1, 16777216])"},
      {"18 no view", R"({"camera": {"pinhole": {"fov_deg": 0}, )" + at + "}", ErrorCode::scene,
       "/camera/pinhole/fov_deg: error: expected a number (got 0, allowed (0, 180))"},
      {"18 half space", R"({"camera": {"pinhole": {"fov_deg": 180}, )" + at + "}", ErrorCode::scene,
       "(got 180, allowed (0, 180))"},
      {"19 singular", shaped(unit + R"(, "transform": {"scale": 0})"), ErrorCode::scene,
       "/shapes/0/transform/scale: error: expected a number (got 0, allowed (0, 1000000000])"},
      {"19 no axis", shaped(unit + R"(, "transform": {"rotate": {"axis": [0, 0, 0], "deg": 3}})"),
       ErrorCode::scene, "a direction must not be zero"},
      {"20 future", R"({"abbe": 2, "what": 3})", ErrorCode::scene,
       "/abbe: error: future version of the scene format (got 2, allowed 1)"},
      {"21 index 0", R"({"materials": {"m": {"dielectric": {"ior": 0}}}})", ErrorCode::scene,
       "(got 0, allowed (0, 100])"},
      {"21 index -1", R"({"materials": {"m": {"dielectric": {"ior": {"n": -1}}}}})", ErrorCode::scene,
       "(got -1, allowed (0, 100])"},
      {"21 index NaN", R"({"materials": {"m": {"dielectric": {"ior": NaN}}}})", ErrorCode::scene,
       "(got NaN, allowed finite numbers)"},
      {"21 index of a metal", R"({"materials": {"m": {"conductor": {"ior": {"n": 0.2, "k": -3}}}}})",
       ErrorCode::scene, "/materials/m/conductor/ior/k: error: expected a number (got -3, allowed [0, 100])"},
      {"23 reflectance", painted("1.2"), ErrorCode::scene,
       "/materials/m/diffuse/reflectance: error: curve out of range at 300 nm (got 1.2, allowed [0, 1])"},
      {"23 reflectance", painted("-0.1"), ErrorCode::scene, "(got -0.1, allowed [0, 1])"},
      {"23 mirror", R"({"materials": {"m": {"mirror": {"reflectance": 1.1}}}})", ErrorCode::scene,
       "/materials/m/mirror/reflectance: error: curve out of range at 300 nm (got 1.1, allowed [0, 1])"},
      {"23 ground", R"({"materials": {"m": {"coated_diffuse": {"ior": 1.5, "reflectance": -1}}}})",
       ErrorCode::scene, "/materials/m/coated_diffuse/reflectance: error: curve out of range"},
      {"23 weight",
       R"({"materials": {"g": {"diffuse": {"reflectance": 0}}, "m": {"mixture": [{"material": "g", "weight": 1.5}]}}})",
       ErrorCode::scene, "(got 1.5, allowed [0, 1])"},
      {"23 thin coat", R"({"materials": {"m": {"coated_diffuse": {"ior": 0.9, "reflectance": 1}}}})",
       ErrorCode::scene,
       "/materials/m/coated_diffuse/ior: error: a clear coat must have n of 1 or more (got n = 0.9 at 300 "
       "nm)"},
      {"23 metal coat",
       R"({"materials": {"m": {"coated_diffuse": {"ior": {"n": 1.5, "k": 1}, "reflectance": 1}}}})",
       ErrorCode::scene, "a clear coat must not absorb (got k = 1 at 300 nm, allowed [0, 0.001])"},
      {"23 weights", R"({"materials": {"a": {"diffuse": {"reflectance": 0}}, "m": {"mixture":
       [{"material": "a", "weight": 0.7}, {"material": "a", "weight": {"band": [500, 600], "value": 0.4}}]}}})",
       ErrorCode::scene,
       "/materials/m/mixture: error: the weights of a mixture must add up to at most 1 (got 1.1)"},
      {"28 exponent", R"({"materials": {"m": {"phong": {"reflectance": 1, "exponent": -2}}}})",
       ErrorCode::scene,
       "/materials/m/phong/exponent: error: expected a number (got -2, allowed [0, 10000])"},
      {"23 exponent", R"({"materials": {"m": {"retroreflector": {"reflectance": 2, "exponent": 2}}}})",
       ErrorCode::scene, "(got 2, allowed [0, 1])"},
      {"28 roughness", R"({"materials": {"m": {"principled": {"base_color": 1, "roughness": -0.1}}}})",
       ErrorCode::scene,
       "/materials/m/principled/roughness: error: expected a number (got -0.1, allowed [0, 1])"},
      {"23 base", R"({"materials": {"m": {"principled": {"base_color": 1.1}}}})", ErrorCode::scene,
       "/materials/m/principled/base_color: error: curve out of range"},
      {"23 cosine", R"({"materials": {"m": {"cosine_power": {"reflectance": 1.01, "exponent": 2}}}})",
       ErrorCode::scene, "(got 1.01, allowed [0, 1])"},
      {"28 sigma", R"({"materials": {"m": {"oren_nayar": {"reflectance": 1, "sigma_deg": -1}}}})",
       ErrorCode::scene,
       "/materials/m/oren_nayar/sigma_deg: error: expected a number (got -1, allowed [0, 90])"},
      {"26 thickness", R"({"materials": {"m": {"thin_glass": {"ior": 1.5, "thickness": -1}}}})",
       ErrorCode::scene, "/materials/m/thin_glass/thickness: error: expected a number (got -1, allowed [0, "},
      {"12 mixed",
       R"({"materials": {"m": {"mixture": [{"material": "clay", "weight": 1}]}, "clai": {"diffuse": {"reflectance": 1}}}})",
       ErrorCode::scene, "/materials/m/mixture/0/material: error: unknown material \"clay\""},
      {"13 mixture of itself", R"({"materials": {"m": {"mixture": [{"material": "m", "weight": 1}]}}})",
       ErrorCode::scene, "material \"m\" cannot be mixed: a mixture within a mixture"},
      {"mixture of glass",
       R"({"materials": {"g": {"dielectric": {"ior": 1.5}}, "m": {"mixture": [{"material": "g", "weight": 1}]}}})",
       ErrorCode::scene,
       "material \"g\" cannot be mixed: it has a medium inside, which a mixture cannot have"},
      {"mixture of a polariser",
       R"({"materials": {"p": {"polariser": {}}, "m": {"mixture": [{"material": "p", "weight": 1}]}}})",
       ErrorCode::scene,
       "material \"p\" cannot be mixed: its axis would be lost, because a mixture has one axis for all "
       "components"},
      {"23 extinction", R"({"materials": {"m": {"polariser": {"extinction_ratio": 0.5}}}})", ErrorCode::scene,
       "/materials/m/polariser/extinction_ratio: error: curve out of range at 300 nm (got 0.5, allowed [1, "},
      {"23 birefringence", R"({"materials": {"m": {"wave_plate": {"birefringence": -0.1, "thickness": 1}}}})",
       ErrorCode::scene,
       "/materials/m/wave_plate/birefringence: error: curve out of range at 300 nm (got -0.1, allowed [0, "
       "10])"},
      {"23 element", R"({"materials": {"m": {"depolariser": {"transmittance": 1.1}}}})", ErrorCode::scene,
       "/materials/m/depolariser/transmittance: error: curve out of range at 300 nm (got 1.1, allowed [0, "
       "1])"},
      {"no retardance", R"({"materials": {"m": {"wave_plate": {}}}})", ErrorCode::scene, "retardance_deg"},
      {"24 unsorted",
       painted(R"({"table": {"wavelength_nm": [500, 400], "values": [0, 1], "outside": "zero"}})"),
       ErrorCode::scene, "wavelengths must ascend (got 400 nm after 500 nm)"},
      {"24 duplicate",
       painted(R"({"table": {"wavelength_nm": [400, 400], "values": [0, 1], "outside": "zero"}})"),
       ErrorCode::scene, "wavelengths must ascend (got 400 nm after 400 nm)"},
      {"24 one sample", painted(R"({"table": {"wavelength_nm": [400], "values": [1], "outside": "zero"}})"),
       ErrorCode::scene, "a table needs two samples or more (got 1)"},
      {"24 micrometres",
       painted(R"({"table": {"wavelength_nm": [0.4, 500], "values": [0, 1], "outside": "zero"}})"),
       ErrorCode::scene, "(got 0.4, allowed [100, 100000])"},
      {"24 angstroms",
       painted(R"({"table": {"wavelength_nm": [4000, 7000], "values": [0, 1], "outside": "zero"}})"),
       ErrorCode::scene, "lie outside [300, 1100] nm; is the unit right?"},
      {"24 lengths", painted(R"({"table": {"wavelength_nm": [400, 500], "values": [1], "outside": "zero"}})"),
       ErrorCode::scene, "(got 1 values, allowed 2)"},
      {"25 emission", lit(R"({"spectrum": -1})"), ErrorCode::scene, "(got -1, allowed [0, 1e+30])"},
      {"26 absorption", R"({"materials": {"m": {"dielectric": {"ior": 1.5, "absorption_per_m": -1}}}})",
       ErrorCode::scene, "(got -1, allowed [0, 1e+30])"},
      {"26 thickness",
       R"({"materials": {"m": {"dielectric": {"ior": 1.5, "coating": [{"ior": 1.38, "thickness_nm": -1}]}}}})",
       ErrorCode::scene, "thickness_nm: error: expected a number (got -1, allowed"},
      {"a priority of what has no inside",
       R"({"materials": {"m": {"diffuse": {"reflectance": 0}, "priority": 1}}})", ErrorCode::scene,
       "/materials/m/priority: error: priority applies only to a medium inside a shape: a dielectric or a "
       "medium"},
      {"a fractional priority", R"({"materials": {"m": {"dielectric": {"ior": 1.5}, "priority": 0.5}}})",
       ErrorCode::scene, "expected an integer (got 0.5, allowed [-1000, 1000])"},
      {"28 roughness", R"({"materials": {"m": {"dielectric": {"ior": 1.5, "roughness": -0.1}}}})",
       ErrorCode::scene,
       "/materials/m/dielectric/roughness: error: expected a number (got -0.1, allowed [0, 1])"},
      {"28 no number",
       R"({"materials": {"m": {"conductor": {"ior": 1.5, "roughness": {"alpha": [0.1, NaN]}}}}})",
       ErrorCode::scene, "NaN"},
      {"28 distribution",
       R"({"materials": {"m": {"conductor": {"ior": 1.5, "roughness": {"alpha": 0.1, "distribution": "gxx"}}}}})",
       ErrorCode::scene, "unknown distribution \"gxx\""},
      {"28 stretched", R"({"materials": {"m": {"conductor": {"ior": 1.5, "roughness": [0.01, 0.21]}}}})",
       ErrorCode::scene,
       "roughness: error: the two alphas must not differ by more than a factor of 20 (got 0.01 and 0.21)"},
      {"28 coated",
       R"({"materials": {"m": {"conductor": {"ior": 1.5, "roughness": 0.1, "coating": [{"ior": 1.38, "thickness_nm": 1}]}}}})",
       ErrorCode::scene, "roughness: error: a coating needs a smooth surface"},
      {"27 empty band", sensed(R"("resolution": [1, 1], "channels": {"R": {"band": [600, 600]}})"),
       ErrorCode::scene,
       "/sensor/channels/R/band: error: an empty band (got [600, 600] nm, allowed low < high)"},
      {"27 zero response", sensed(R"("resolution": [1, 1], "channels": {"R": 0})"), ErrorCode::scene,
       "channel \"R\" responds to no wavelength in [300, 1100] nm"},
      {"27 nothing in common", sensed(R"("resolution": [1, 1], "quantum_efficiency": {"band": [400, 500]},
                                         "channels": {"R": {"band": [600, 700]}})"),
       ErrorCode::scene, "responds to no wavelength"},
      {"30 index",
       shaped(R"("mesh": {"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 1, 3]]})"),
       ErrorCode::input, "triangle 0 names a vertex that does not exist (got 3, allowed [0, 2])"},
      {"30 fractional index",
       shaped(R"("mesh": {"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 1, 0.5]]})"),
       ErrorCode::scene,
       "/shapes/0/mesh/triangles/0/2: error: expected an integer (got 0.5, allowed [0, 4294967295])"},
      {"33 zero area",
       R"({"lights": [{"quad": {"corner": [0, 0, 0], "edge_u": [1, 0, 0], "edge_v": [2, 0, 0]},
                          "emission": {"spectrum": 1}}]})",
       ErrorCode::input, "a quad of zero area (got 0, allowed (0, inf))"},
      {"39 a folder as mesh", shaped(R"("mesh": ".")"), ErrorCode::input, "not a regular file"},
      {"missing mesh", shaped(R"("mesh": "none.ply")"), ErrorCode::input, "no such file"},
      {"38 URL", shaped(R"("mesh": "http://example.org/a.ply")"), ErrorCode::input,
       "expected a file (got the URL"},
      {"two cameras", R"({"camera": {"pinhole": {"fov_deg": 9}, "thin_lens": {}, )" + at + "}",
       ErrorCode::scene,
       "expected exactly one key (got pinhole, thin_lens, allowed pinhole, thin_lens, lens_system, "
       "irradiance_probe)"},
      {"up along the sight",
       R"({"camera": {"pinhole": {"fov_deg": 9}, "from": [0, 0, 1], "to": [0, 0, 0], "up": [0, 0, 1]}})",
       ErrorCode::scene, "up is parallel"},
      {"too near",
       R"({"camera": {"thin_lens": {"focal_length": 2, "f_number": 4, "focus_distance": 2}, )" + at + "}",
       ErrorCode::scene, "the lens cannot focus within its focal length (got 2 m, allowed (2, inf) m)"},
      {"a lens that is none", R"({"camera": {"lens_system": {"prescription": "double_gaus"}, )" + at + "}",
       ErrorCode::input,
       "/camera/lens_system/prescription: error: unknown lens \"double_gaus\"; did you mean "
       "\"double_gauss\"?"},
      {"a lens too far open",
       R"({"camera": {"lens_system": {"prescription": "double_gauss", "f_number": 1.4}, )" + at + "}",
       ErrorCode::scene,
       "/camera/lens_system/f_number: error: the lens cannot open that far (got f/1.4, allowed f/2 "
       "or more)"},
      {"two blades",
       R"({"camera": {"thin_lens": {"focal_length": 0.05, "f_number": 4, "blades": 2}, )" + at + "}",
       ErrorCode::scene, "/camera/thin_lens/blades: error: expected an integer (got 2, allowed [3, 32])"},
      {"a lens faster than any in air",
       R"({"camera": {"thin_lens": {"focal_length": 0.05, "f_number": 0.1, "focus_distance": "infinity"}, )" +
           at + "}",
       ErrorCode::scene,
       "/camera/thin_lens/f_number: error: expected a number (got 0.1, allowed [0.5, 1000000])"},
      {"a pinhole that exposes more than a hemisphere of light",
       R"({"camera": {"pinhole": {"fov_deg": 9, "t_stop": 0.499}, )" + at + "}", ErrorCode::scene,
       "/camera/pinhole/t_stop: error: expected a number (got 0.499, allowed [0.5, 1000000])"},
      {"blades of a lens in air",
       R"({"camera": {"thin_lens": {"focal_length": 0.05, "t_stop": 0.5, "blades": 4}, )" + at + "}",
       ErrorCode::scene,
       "/camera/thin_lens/t_stop: error: a T-stop must not be faster than its blades allow (got 0.5, allowed "
       "[0.6266"},
      {"faster than blades let it be",
       R"({"camera": {"thin_lens": {"focal_length": 0.05, "f_number": 4, "t_stop": 4, "blades": 4}, )" + at +
           "}",
       ErrorCode::scene,
       "/camera/thin_lens/t_stop: error: a T-stop must not be faster than its f-number and blades allow (got "
       "4, allowed [5.013"},
      {"a lens of no kind", R"({"camera": {"lens_system": {"prescription": 50}, )" + at + "}",
       ErrorCode::scene,
       "/camera/lens_system/prescription: error: expected a lens: its name, a file, or an object with its "
       "surfaces (got a number)"},
      {"a lens without a stop",
       R"({"camera": {"lens_system": {"prescription": {"f_number": 4, "surfaces": [[50, 4, 1.5], [-50, 40]]}}, )" +
           at + "}",
       ErrorCode::scene,
       "/camera/lens_system/prescription: error: a lens needs a stop, and no surface is marked as the stop"},
      {"a glass that is none, within a short surface",
       R"({"camera": {"lens_system": {"prescription": {"f_number": 4, "surfaces": [{"stop": true, "thickness": 1}, [50, 4, "N-BK77"], [-50, 40]]}}, )" +
           at + "}",
       ErrorCode::scene, "/camera/lens_system/prescription/surfaces/1/2: error: unknown "},
      {"a short surface of one number",
       R"({"camera": {"lens_system": {"prescription": {"f_number": 4, "surfaces": [{"stop": true, "thickness": 1}, [50]]}}, )" +
           at + "}",
       ErrorCode::scene,
       "/camera/lens_system/prescription/surfaces/1: error: an array in place of this object has the values "
       "radius, "
       "thickness, glass, aperture (got 1 values, allowed 2 to 4)"},
      {"too near for a real lens",
       R"({"camera": {"lens_system": {"prescription": "double_gauss", "focus_distance": 0.01}, )" + at + "}",
       ErrorCode::scene, "the lens forms no image behind it of an object at the focus distance (got "},
      {"relative spectrum", lit(R"({"illuminant": "A"})"), ErrorCode::scene,
       "illuminant is a relative spectrum and needs a scale, one of radiant_flux_W, luminous_flux_lm, "
       "intensity, luminous_intensity"},
      {"two scales", lit(R"({"illuminant": "A", "intensity": 1, "radiant_flux_W": 1})"), ErrorCode::scene,
       "an emission has one scale (got radiant_flux_W and intensity)"},
      {"a lamp around the meter",
       R"({"lights": [{"sphere": {"center": [0, 0, 0], "radius": 2}, "emission": {"illuminant": "A", "illuminance": 9, "distance": 2}}]})",
       ErrorCode::scene, "/lights/0/emission: error: the distance lies inside the light (got 2)"},
      {"no distance", lit(R"({"illuminant": "A", "illuminance": 9})"), ErrorCode::scene,
       "missing key \"distance\""},
      {"a distance of nothing", lit(R"({"illuminant": "A", "luminous_intensity": 9, "distance": 1})"),
       ErrorCode::scene, "distance requires irradiance or illuminance, which is missing"},
      {"negative flux", lit(R"({"spectral_flux_W_per_nm": -1})"), ErrorCode::scene,
       "(got -1, allowed [0, 1e+30])"},
      {"a body of a few float steps",
       R"({"materials": {"g": {"dielectric": {"ior": 1.5}}}, "shapes": [{"sphere": {"center": [0, 0, 0], "radius": 1}, "material": "g"},
           {"sphere": {"center": [1e7, 0, 0], "radius": 1}, "material": "g"}]})",
       ErrorCode::scene,
       "/shapes/1: error: shape \"shape 1\" is 3.46 m large and 1e+07 m from the center of the scene, where "
       "single precision resolves 1.19 m: too coarse for a shape with a medium inside (got 2.91 steps, "
       "allowed [64, inf))"},
      {"a lamp of triangles of a few float steps",
       R"({"materials": {"g": {"diffuse": {"reflectance": 0}}}, "shapes": [{"sphere": {"center": [0, 0, 0], "radius": 1}, "material": "g"},
           {"mesh": {"vertices": [[1e7, 0, 0], [1e7, 9, 0], [1e7, 0, 9]], "triangles": [[0, 1, 2]]}, "material": "g", "emission": {"spectrum": 1}}]})",
       ErrorCode::scene, "too coarse for an emitting mesh"},
      {"a camera far from what it sees",
       R"({"materials": {"g": {"diffuse": {"reflectance": 0}}}, "shapes": [{"sphere": {"center": [0, 1e7, 0], "radius": 1}, "material": "g"}]})",
       ErrorCode::scene,
       "/camera: error: the camera is 1e+07 m from the visible scene, which is 3.46 m large"},
      {"a pixel of a direction",
       R"({"camera": {"pinhole": {"focal_length": 100}, "from": [0, -3, 0], "to": [0, 0, 0], "up": [0, 0, 1]}})",
       ErrorCode::scene, "/camera: error: a pixel covers 4.5e-08 rad"},
      {"a sun from nowhere", R"({"lights": [{"sun": {"towards": [0, 0, 0], "illuminance": 1}}]})",
       ErrorCode::scene, "a direction must not be zero"},
      {"a sun too small",
       R"({"lights": [{"sun": {"towards": [0, 0, 1], "angular_diameter_deg": 0.001, "illuminance": 1}}]})",
       ErrorCode::scene, "allowed [0.01, 60]"},
      {"a sun of two strengths",
       R"({"lights": [{"sun": {"towards": [0, 0, 1], "illuminance": 1}, "emission": {"illuminant": "A", "illuminance": 1}}]})",
       ErrorCode::scene, "/lights/0/sun/illuminance"},
      {"a sun of no strength", R"({"lights": [{"sun": {"towards": [0, 0, 1]}}]})", ErrorCode::scene,
       "emission"},
      {"a beam has no radiance",
       R"({"lights": [{"directional": {"towards": [0, 0, 1]}, "emission": {"spectrum": 1, "radiance": 1}}]})",
       ErrorCode::scene, "radiance"},
      {"a sky has no flux", R"({"lights": [{"environment": {}, "emission": {"spectral_flux_W_per_nm": 1}}]})",
       ErrorCode::scene,
       "expected exactly one key (got none, allowed illuminant, blackbody_K, daylight_K, spectrum, lines)"},
      {"a scale of other lamps", lit(R"({"spectrum": 1, "radiance": 1})"), ErrorCode::scene,
       "unknown key \"radiance\""},
      {"invisible", lit(R"({"spectrum": {"band": [900, 1000]}, "luminous_intensity": 1})"), ErrorCode::scene,
       "luminous_intensity cannot scale this spectrum"},
      {"two skies",
       R"({"lights": [{"environment": {}, "emission": {"spectrum": 1}}, {"environment": {}, "emission": {"spectrum": 1}}]})",
       ErrorCode::scene, "a scene has at most one environment light"},
      {"glass brings its own",
       R"({"materials": {"m": {"dielectric": {"ior": "N-BK7", "absorption_per_m": 1}}}})", ErrorCode::scene,
       "absorption_per_m requires an index without k; this index already has one"},
      {"unknown glass", R"({"materials": {"m": {"dielectric": {"ior": "N-BK77"}}}})", ErrorCode::scene,
       "did you mean \"N-BK7\"?"},
      {"energy times efficiency",
       sensed(R"("resolution": [1, 1], "response": "energy", "quantum_efficiency": 1, "channels": {"R": 1})"),
       ErrorCode::scene, "quantum_efficiency requires a quantum response"},
      {"observer has its own", sensed(R"("resolution": [1, 1], "observer": "1931", "quantum_efficiency": 1)"),
       ErrorCode::scene, "quantum_efficiency is used with channels only"},
      {"a name EXR cannot hold", sensed(R"("resolution": [1, 1], "channels": {"a.b": 1})"), ErrorCode::scene,
       "letters, digits, - and _ (got \"a.b\")"},
      {"a name too long for EXR",
       sensed(R"("resolution": [1, 1], "channels": {")" + std::string(101, 'a') + R"(": 1})"),
       ErrorCode::scene, "at most 100 characters"},
      {"unknown unit", R"({"units": "ft"})", ErrorCode::scene, "unknown unit of length \"ft\""},
  };
  expect_refused(faults);
}

TEST_F(DescriptionFaultsTest, NamesThePlaceAndTheKeysThatAreMissing) {
  const Loaded loaded = load_text(
      "{\n  \"abbe\": 1,\n  \"sensor\": {\"resolution\": [4, 3], \"observer\": 1931},\n"
      "  \"render\": {\"samples\": 0}\n}");
  EXPECT_EQ(
      loaded.text(),
      fmt::format("{0}:4:25: /render/samples: error: expected an integer (got 0, allowed [1, 16777216])\n"
                  "  \"render\": {{\"samples\": 0}}\n                        ^\n"
                  "{0}:1:1: error: missing key \"camera\" or \"meters\"\n{{\n^\n",
                  (folder_ / "scene.json").string()));
  Diagnostics missing;
  EXPECT_FALSE(load_scene(folder_ / "none.json", {}, missing));
  EXPECT_EQ(missing.code(), ErrorCode::input);
}

TEST_F(DescriptionFaultsTest, WarnsOfDarknessAndExtrapolation) {
  const Loaded dark = load("{}");
  EXPECT_TRUE(dark.scene);
  EXPECT_NE(dark.text().find("warning: no light: the image will be black"), std::string::npos);

  const std::string sensor =
      R"("sensor": {"resolution": [1, 1], "channels": {"red": {"band": [600, 700]}}},)";
  const auto lamp_of = [&](const std::string& spectrum) {
    return load("{" + sensor +
                R"("lights": [{"name": "bulb", "point": {"at": [0, 0, 1]}, "emission": {"spectrum": )" +
                spectrum + "}}]}")
        .text();
  };
  EXPECT_NE(lamp_of("0").find("/lights/0/emission: warning: \"bulb\" emits nothing\n"), std::string::npos);
  EXPECT_NE(lamp_of(R"({"band": [400, 500]})")
                .find("/lights/0/emission: warning: \"bulb\" emits nothing that the sensor records\n"),
            std::string::npos);
  EXPECT_EQ(lamp_of(R"({"band": [400, 610]})"), "");

  // 22: a warning reports an index that is used outside its measurements.
  const std::string lamp = R"({"lights": [{"environment": {}, "emission": {"spectrum": 1}}],)";
  const Loaded beyond = load(lamp + R"("materials": {"m": {"dielectric": {"ior": "N-SF11"}}}})");
  EXPECT_NE(beyond.text().find("/materials/m: warning: N-SF11 has data on [370, 2500] nm, but the sensor "
                               "responds on [300, 1100] nm: "
                               "outside its data, the index of the nearer end is used"),
            std::string::npos)
      << beyond.text();
  const Loaded within = load(lamp + R"("materials": {"m": {"dielectric": {"ior": "N-SF11"}}},
    "sensor": {"resolution": [1, 1], "channels": {"a": {"band": [400, 500]}, "b": {"band": [600, 700]}}}})");
  EXPECT_EQ(within.text(), "");
}

TEST_F(DescriptionFaultsTest, TheLeastThatAFileCanSayIsHeld) {
  for (const char* least : {"5e-324", "1e-318", "1e-310"}) {
    const Loaded faint = load(fmt::format(
        R"({{"lights": [{{"directional": {{"towards": [0, 0, 1], "irradiance": {}}}}}]}})", least));
    ASSERT_TRUE(faint.scene) << faint.text();
    EXPECT_TRUE(std::isfinite(faint->lights.at(0).emission.curve().max())) << least;
  }
  const Loaded mirror = load(R"({"materials": {"m": {"schlick": {"ior": 0}}}})");
  ASSERT_TRUE(mirror.scene) << mirror.text();
}

}  // namespace
}  // namespace abbe
