#include "cli/command_options.h"

#include <array>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cli/arguments.h"
#include "cli/lab.h"
#include "cli/query.h"
#include "spectral/colorimetry.h"

namespace abbe::cli {
namespace {

// Coordinates of CIELAB within 1e6: far outside all colours, but small enough for finite results.
Lab parse_lab(const std::string& option, const std::string& text) {
  constexpr double kMaxMagnitude = 1e6;
  (void)parse_numbers(option, text, -kMaxMagnitude, kMaxMagnitude);
  return parse_triple(option, text);
}

void add_at(CLI::App& app, std::vector<double>& at_nm) {
  add_parsed(app, "--at", at_nm, numbers_in(0, kAnyNumber), "Wavelengths in standard air in nm", "NM[,NM...]")
      ->required();
}

void add_json_with_arrays(CLI::App& app, bool& json, bool& arrays) {
  add_json(app, json);
  app.add_flag("--arrays", arrays, "Print lists in JSON even for a single wavelength or angle")
      ->needs("--json");
}

constexpr const char* kMaterialHelp = "Name of a material, FILE.csv, or FILE.yml of refractiveindex.info";

Subcommand<IndexOptions> add_index_query(CLI::App& query, const std::string& name, const std::string& help,
                                         Command& command, void (*run)(const IndexOptions&)) {
  Subcommand<IndexOptions> sub(query, name, help, command, run);
  add_value(*sub.app, "name", sub->name, kMaterialHelp, "MATERIAL")->required();
  add_at(*sub.app, sub->at_nm);
  add_json_with_arrays(*sub.app, sub->json, sub->arrays);
  return sub;
}

void add_material_queries(CLI::App& query, Command& command) {
  const Subcommand<IndexOptions> ior =
      add_index_query(query, "ior", "Refractive index n + ik as catalogued; k is - if it is not measured",
                      command, query_ior);
  add_parsed(*ior.app, "--thickness", ior->thickness_mm, number_in(0, kAnyNumber),
             "Thickness of a sample in mm, whose internal transmittance is also printed", "MM");
  add_index_query(query, "critical", "Critical angle of total reflection inside a material in air", command,
                  query_critical);
  add_index_query(query, "brewster",
                  "Brewster's angle for light from air; for metals the pseudo-Brewster angle of minimum Rp",
                  command, query_brewster);

  const Subcommand<ReflectanceOptions> reflectance(
      query, "reflectance",
      "Reflectance of a polished surface in air, or in the medium to which its index is relative", command,
      query_reflectance);
  add_value(*reflectance.app, "name", reflectance->name, kMaterialHelp, "MATERIAL")->required();
  add_at(*reflectance.app, reflectance->at_nm);
  add_parsed(*reflectance.app, "--angle", reflectance->angles_deg, numbers_in(0, 90),
             "Angles of incidence in degrees, 0 to 90 (default 0)", "DEG[,DEG...]");
  add_value(*reflectance.app, "--coating", reflectance->coating,
            "Thin films on the surface with their thicknesses in nm, from outside inwards; light then "
            "comes from air, and the transmittance T is also printed",
            "MATERIAL:NM[,MATERIAL:NM...]");
  add_json_with_arrays(*reflectance.app, reflectance->json, reflectance->arrays);

  const Subcommand<PrismOptions> prism(
      query, "prism", "Deviation by a prism in air, at minimum deviation or at a given incidence", command,
      query_prism);
  add_value(*prism.app, "name", prism->name, kMaterialHelp, "MATERIAL")->required();
  add_at(*prism.app, prism->at_nm);
  add_parsed(*prism.app, "--apex", prism->apex_deg, number_in(1e-6, 180 - 1e-6),
             "Apex angle in degrees, between 0 and 180", "DEG")
      ->required();
  add_parsed(
      *prism.app, "--incidence", prism->incidence_deg, number_in(-90 + 1e-6, 90 - 1e-6),
      "Angle of incidence at the first face in degrees, within 90 (default: that of minimum deviation)",
      "DEG");
  add_json_with_arrays(*prism.app, prism->json, prism->arrays);
}

// Adds --range, which selects one of the ranges of colorimetric sums.
template <typename Range>
void add_sum_range(CLI::App& app, Range& range) {
  const auto parse = [](const std::string& option, const std::string& text) {
    constexpr std::array<SumRange, 2> kRanges{SumRange{}, kVisibleRange};
    std::vector<std::string> names;
    for (const SumRange& r : kRanges) names.push_back(fmt::format("{}-{}", r.low_nm, r.high_nm));
    return kRanges.at(static_cast<std::size_t>(parse_choice(option, text, names)));
  };
  add_parsed(app, "--range", range, parse,
             "Wavelengths in nm over which colours are summed: those of the CIE observers (default 360-830), "
             "or fewer for comparison with programs that truncate them",
             "360-830|380-780");
}

void add_color_queries(CLI::App& query, Command& command) {
  const Subcommand<ColorOptions> color(query, "color", "Colour of a reflectance under an illuminant", command,
                                       query_color);
  add_value(*color.app, "--illuminant", color->illuminant,
            "Name of an illuminant, blackbody:K or daylight:K with a temperature in K", "ILLUMINANT")
      ->required();
  add_parsed(*color.app, "--observer", color->observer, one_of<Observer>({"1931", "1964"}),
             "Standard observer of the CIE: 1931 (2 degrees) or 1964 (10 degrees) (default 1931)",
             "1931|1964");
  add_value(*color.app, "--reflectance", color->reflectance,
            "Name of a reflectance, or FILE.csv:COLUMN (default: perfect diffuser)", "REFLECTANCE");
  add_parsed(
      *color.app, "--method", color->method, one_of<ColorMethod>({"1nm", "astm-e308"}),
      "Sum in steps of 1 nm, or over the measured wavelengths with the weights of ASTM E308 (default 1nm)",
      "1nm|astm-e308");
  add_sum_range(*color.app, color->range);
  add_json(*color.app, color->json);

  const Subcommand<DeltaEOptions> delta_e(
      query, "delta-e", "Differences of two CIELAB colours by several formulas", command, query_delta_e);
  add_parsed(*delta_e.app, "standard", delta_e->lab1, parse_lab,
             "CIELAB coordinates L*,a*,b* of the standard", "L,a,b")
      ->required();
  add_parsed(*delta_e.app, "sample", delta_e->lab2, parse_lab, "CIELAB coordinates L*,a*,b* of the sample",
             "L,a,b")
      ->required();
  add_json(*delta_e.app, delta_e->json);

  const Subcommand<CameraOptions> camera(
      query, "camera", "Raw values of a camera, scaled to 1 for green of the perfect diffuser", command,
      query_camera);
  add_value(*camera.app, "name", camera->name, "Name of a camera, or FILE.csv of spectral responses",
            "CAMERA")
      ->required();
  add_value(*camera.app, "--illuminant", camera->illuminant,
            "Name of an illuminant, blackbody:K or daylight:K with a temperature in K", "ILLUMINANT");
  add_value(*camera.app, "--reflectance", camera->reflectance,
            "Name of a reflectance, or FILE.csv:COLUMN (default: perfect diffuser)", "REFLECTANCE")
      ->needs("--illuminant");
  camera.app
      ->add_flag("--judge", camera->metrics,
                 "Print metrics of colour accuracy instead: Vora value, residuals of Luther's condition, "
                 "sensitivity metamerism index")
      ->excludes("--illuminant");
  add_response(*camera.app, "--response", camera->response);
  add_json(*camera.app, camera->json);
}

void add_light_queries(CLI::App& query, Command& command) {
  const Subcommand<LightOptions> light(
      query, "light", "Colour temperature, colour rendering (Ra, TM-30) and luminous efficacy of a light",
      command, query_light);
  add_value(*light.app, "name", light->name,
            "Name of an illuminant, blackbody:K, daylight:K, FILE.csv:COLUMN, or a spectral image FILE.exr",
            "ILLUMINANT")
      ->required();
  add_value(*light.app, "--filter", light->filters, "Filters through which the light passes: names or files",
            "FILTER[,FILTER...]");
  add_value(*light.app, "--reflectance", light->reflectance,
            "Surface that reflects the light: a name or FILE.csv:COLUMN", "REFLECTANCE");
  add_parsed(*light.app, "--crop", light->crop, parse_crop,
             "Pixels of a spectral image to average, X0 <= x < X1 and Y0 <= y < Y1 (default: all)",
             "X0,Y0,X1,Y1");
  add_value(*light.app, "--plot", light->plot, "Colour vector graphic of TM-30 to write", "FILE.svg");
  light.app->add_flag("--samples", light->samples,
                      "Also print the colour fidelity of each of the 99 samples");
  add_sum_range(*light.app, light->range);
  add_max_memory(*light.app, light.options);
  add_json(*light.app, light->json);

  const Subcommand<MetamerismOptions> metamers(
      query, "metamerism",
      "Colour difference, under a test illuminant, of two surfaces that match under a reference illuminant",
      command, query_metamerism);
  for (auto* name : {&metamers->first, &metamers->second})
    add_value(*metamers.app, name == &metamers->first ? "first" : "second", *name,
              "Name of a reflectance, or FILE.csv:COLUMN", "REFLECTANCE")
        ->required();
  add_value(*metamers.app, "--reference", metamers->reference, "Illuminant under which the surfaces match",
            "ILLUMINANT")
      ->capture_default_str();
  add_value(*metamers.app, "--test", metamers->test, "Illuminant under which the surfaces are compared",
            "ILLUMINANT")
      ->capture_default_str();
  add_sum_range(*metamers.app, metamers->range);
  add_json(*metamers.app, metamers->json);
}

}  // namespace

void add_query(CLI::App& app, Command& command) {
  CLI::App* query = app.add_subcommand("query", "Look up data and evaluate closed forms");
  auto options = std::make_shared<ListOptions>();
  CLI::Option* list =
      add_value(*query, "--list", options->kind, "List the names of all kinds of data, or of one", "[KIND]")
          ->expected(0, 1);
  query->add_flag("--json", options->json, "Print the list as one JSON object")->needs(list);
  add_material_queries(*query, command);
  add_color_queries(*query, command);
  add_light_queries(*query, command);
  query->callback([query, list, options, &command] {
    if (const auto questions = query->get_subcommands(); !questions.empty()) {
      if (list->count() == 0) return;
      throw Error(ErrorCode::usage, "--list",
                  fmt::format("lists names only and cannot be combined with a query (got {}, allowed alone)",
                              questions.front()->get_name()));
    }
    if (list->count() == 0) throw CLI::RequiredError("query: the name of a query, or --list,");
    command = [options] {
      query_list(*options);
      return 0;
    };
  });
}

void add_lab(CLI::App& app, Command& command) {
  const Subcommand<LabOptions> sub(app, "lab", "Measure the scattering of a material on the BSDF bench",
                                   command, lab);
  CLI::App& options = *sub.app;
  add_value(
      options, "material", sub->material,
      "Scene file and name of one of its materials, file of a single material, or the JSON of a material",
      "FILE.json[:NAME]|JSON")
      ->required();
  add_parsed(options, "--at", sub->at_nm, numbers_in(kMinWavelengthNm, kMaxWavelengthNm),
             "Wavelengths in standard air in nm (default 450,550,650)", "NM[,NM...]");
  add_parsed(options, "--angle", sub->angles_deg, numbers_in(0, 89.9),
             "Angles of incidence in degrees, 0 to 89.9 (default 0,15,30,45,60,75,85)", "DEG[,DEG...]");
  options.add_flag("--inside", sub->inside, "Illuminate the surface from inside the material");
  add_value(options, "--illuminant", sub->illuminant, "Illuminant of the colours (default D65)",
            "ILLUMINANT");
  add_parsed(options, "--observer", sub->observer, one_of<Observer>({"1931", "1964"}),
             "Standard observer of the CIE: 1931 (2 degrees) or 1964 (10 degrees) (default 1931)",
             "1931|1964");
  add_parsed(options, "--samples", sub->samples, integer_in<int>(256, kMaxSamples),
             "Samples per angle of incidence and group of eight wavelengths, at least 256 (default 8192)",
             "N");
  add_value(options, "--plot", sub->plot, "Polar plots of the lobes to write", "FILE.svg");
  add_value(options, "--map", sub->map, "Pictures of the hemispheres to write", "FILE.png");
  add_max_memory(options, sub.options);
  add_json(options, sub->json);
}

}  // namespace abbe::cli
