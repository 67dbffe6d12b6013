#include "cli/material_commands.h"

#include <array>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cli/arguments.h"
#include "cli/bench_measurements.h"
#include "cli/lab.h"
#include "cli/query.h"
#include "spectral/colorimetry.h"

namespace abbe::cli {
namespace {

// Far beyond all colours, and near enough for formulas to stay numbers.
Lab parse_lab(const std::string& option, const std::string& text) {
  constexpr double kMost = 1e6;
  (void)parse_numbers(option, text, -kMost, kMost);
  return parse_triple(option, text);
}

void add_at(CLI::App& app, std::vector<double>& at_nm) {
  add_parsed(app, "--at", at_nm, numbers_in(0, kAnyNumber), "Wavelengths in standard air", "NM[,NM...]")
      ->required();
}

void add_json_with_arrays(CLI::App& app, bool& json, bool& arrays) {
  add_json(app, json);
  app.add_flag("--arrays", arrays, "In JSON, give lists for a single wavelength or angle too")
      ->needs(app.get_option("--json"));
}

constexpr const char* kMaterialHelp = "Material, FILE.csv or FILE.yml of refractiveindex.info";

Sub<IndexOptions> add_index_query(CLI::App& query, const std::string& name, const std::string& help,
                                  Command& command, int (*run)(const IndexOptions&)) {
  Sub<IndexOptions> sub(query, name, help, command, run);
  sub.app->add_option("name", sub->name, kMaterialHelp)->required()->type_name("MATERIAL");
  add_at(*sub.app, sub->at_nm);
  add_json_with_arrays(*sub.app, sub->json, sub->arrays);
  return sub;
}

void add_material_queries(CLI::App& query, Command& command) {
  const Sub<IndexOptions> ior =
      add_index_query(query, "ior", "Refractive index n + ik as catalogued; k is - where it is not measured",
                      command, query_ior);
  add_parsed(*ior.app, "--thickness", ior->thickness_mm, number_in(0, kAnyNumber),
             "Also tell the internal transmittance of that many millimetres", "MM");
  add_index_query(query, "critical", "Critical angle from inside, in air", command, query_critical);
  add_index_query(query, "brewster",
                  "Brewster's angle from air, or of metals the pseudo-Brewster angle, where Rp is least",
                  command, query_brewster);

  const Sub<ReflectanceOptions> reflectance(
      query, "reflectance",
      "Reflectance of a polished surface in air, or in what else its index is relative to", command,
      query_reflectance);
  reflectance.app->add_option("name", reflectance->name, kMaterialHelp)->required()->type_name("MATERIAL");
  add_at(*reflectance.app, reflectance->at_nm);
  add_parsed(*reflectance.app, "--angle", reflectance->angles_deg, numbers_in(0, 90),
             "Angles of incidence (default 0)", "DEG[,DEG...]");
  reflectance.app
      ->add_option("--coating", reflectance->coating,
                   "Thin films on it, from outside inwards; light then comes from air, and T is told too")
      ->type_name("MATERIAL:NM[,MATERIAL:NM...]");
  add_json_with_arrays(*reflectance.app, reflectance->json, reflectance->arrays);

  const Sub<PrismOptions> prism(query, "prism", "Deviation by a prism in air, least or at one incidence",
                                command, query_prism);
  prism.app->add_option("name", prism->name, kMaterialHelp)->required()->type_name("MATERIAL");
  add_at(*prism.app, prism->at_nm);
  add_parsed(*prism.app, "--apex", prism->apex_deg, number_in(1e-6, 180 - 1e-6), "Apex angle", "DEG")
      ->required();
  add_parsed(*prism.app, "--incidence", prism->incidence_deg, number_in(-90 + 1e-6, 90 - 1e-6),
             "Incidence at the first face (default: least deviation)", "DEG");
  add_json_with_arrays(*prism.app, prism->json, prism->arrays);
}

// The ranges of colorimetric sums that can be chosen by name.
template <typename Range>
void add_sum_range(CLI::App& app, Range& range) {
  const auto parse = [](const std::string& option, const std::string& text) {
    constexpr std::array<SumRange, 2> kRanges{SumRange{}, kVisibleRange};
    std::vector<std::string> names;
    for (const SumRange& r : kRanges) names.push_back(fmt::format("{}-{}", r.low_nm, r.high_nm));
    return kRanges.at(static_cast<std::size_t>(parse_choice(option, text, names)));
  };
  add_parsed(app, "--range", range, parse,
             "Wavelengths in nm of the sums: those of the CIE's observers (default 360-830), or fewer, for "
             "comparison with programs that truncate them",
             "360-830|380-780");
}

void add_color_queries(CLI::App& query, Command& command) {
  const Sub<ColorOptions> color(query, "color", "Colour of a reflectance under an illuminant", command,
                                query_color);
  color.app->add_option("--illuminant", color->illuminant, "Illuminant, blackbody:K or daylight:K")
      ->required()
      ->type_name("ILLUMINANT");
  add_parsed(*color.app, "--observer", color->observer, one_of<Observer>({"1931", "1964"}),
             "Standard observer (default 1931)", "1931|1964");
  color.app
      ->add_option("--reflectance", color->reflectance, "NAME or FILE.csv:COLUMN (default: perfect diffuser)")
      ->type_name("REFLECTANCE");
  add_parsed(
      *color.app, "--method", color->method, one_of<ColorMethod>({"1nm", "astm-e308"}),
      "Sum over every nanometre, or over the measured wavelengths by the weights of ASTM E308 (default "
      "1nm)",
      "1nm|astm-e308");
  add_sum_range(*color.app, color->range);
  add_json(*color.app, color->json);

  const Sub<DeltaEOptions> delta_e(query, "delta-e", "Difference of two colours", command, query_delta_e);
  add_parsed(*delta_e.app, "standard", delta_e->lab1, parse_lab, "First colour", "L,a,b")->required();
  add_parsed(*delta_e.app, "sample", delta_e->lab2, parse_lab, "Second colour", "L,a,b")->required();
  add_json(*delta_e.app, delta_e->json);

  const Sub<CameraOptions> camera(query, "camera", "Raw values of a camera, green of the perfect diffuser 1",
                                  command, query_camera);
  camera.app->add_option("name", camera->name, "Camera or FILE.csv")->required()->type_name("CAMERA");
  CLI::Option* illuminant =
      camera.app->add_option("--illuminant", camera->illuminant, "Illuminant, blackbody:K or daylight:K")
          ->type_name("ILLUMINANT");
  camera.app
      ->add_option("--reflectance", camera->reflectance,
                   "NAME or FILE.csv:COLUMN (default: perfect diffuser)")
      ->needs(illuminant)
      ->type_name("REFLECTANCE");
  camera.app
      ->add_flag("--judge", camera->judge,
                 "Instead, how near the camera comes to an observer: Vora value, Luther's condition, "
                 "sensitivity metamerism index")
      ->excludes(illuminant);
  add_response(*camera.app, "--response", camera->response);
  add_json(*camera.app, camera->json);
}

void add_light_queries(CLI::App& query, Command& command) {
  const Sub<LightOptions> light(query, "light",
                                "Colour temperature, colour rendering (Ra, TM-30) and efficacy of a light",
                                command, query_light);
  light.app
      ->add_option("name", light->name,
                   "Illuminant, blackbody:K or daylight:K, FILE.csv:COLUMN, or a spectral FILE.exr")
      ->required()
      ->type_name("ILLUMINANT");
  light.app->add_option("--filter", light->filters, "Filters that it goes through")
      ->type_name("FILTER[,FILTER...]");
  light.app->add_option("--reflectance", light->reflectance, "Surface that it comes from")
      ->type_name("REFLECTANCE");
  add_parsed(*light.app, "--crop", light->crop, parse_crop, "Of a spectral image: these pixels alone",
             "X0,Y0,X1,Y1");
  light.app->add_option("--plot", light->plot, "Write the colour vector graphic of TM-30")
      ->type_name("FILE.svg");
  light.app->add_flag("--samples", light->samples, "Print the colour fidelity of each of the 99 samples too");
  add_sum_range(*light.app, light->range);
  add_max_memory(*light.app, light.options);
  add_json(*light.app, light->json);

  const Sub<MetamerismOptions> metamers(query, "metamerism",
                                        "How two surfaces that look alike in one light differ in another",
                                        command, query_metamerism);
  for (auto* name : {&metamers->first, &metamers->second})
    metamers.app->add_option(name == &metamers->first ? "first" : "second", *name, "NAME or FILE.csv:COLUMN")
        ->required()
        ->type_name("REFLECTANCE");
  metamers.app->add_option("--reference", metamers->reference, "Light in which they look alike")
      ->capture_default_str()
      ->type_name("ILLUMINANT");
  metamers.app->add_option("--test", metamers->test, "The other light")
      ->capture_default_str()
      ->type_name("ILLUMINANT");
  add_sum_range(*metamers.app, metamers->range);
  add_json(*metamers.app, metamers->json);
}

}  // namespace

void add_query(CLI::App& app, Command& command) {
  CLI::App* query = app.add_subcommand("query", "Ask the data and the closed forms");
  auto options = std::make_shared<ListOptions>();
  CLI::Option* list =
      query->add_option("--list", options->kind, "List the names of all kinds of data, or of one")
          ->expected(0, 1)
          ->type_name("[KIND]");
  query->add_flag("--json", options->json, "Print the list as one JSON object")->needs(list);
  add_material_queries(*query, command);
  add_color_queries(*query, command);
  add_light_queries(*query, command);
  query->callback([query, list, options, &command] {
    if (const auto questions = query->get_subcommands(); !questions.empty()) {
      if (list->count() == 0) return;
      throw Error(ErrorCode::usage, "--list",
                  fmt::format("lists names, and answers no question beside (got {}, allowed alone)",
                              questions.front()->get_name()));
    }
    if (list->count() == 0) throw CLI::RequiredError("query: a question or --list");
    command = [options] { return query_list(*options); };
  });
}

void add_transfer(CLI::App& app, Command& command) {
  const Sub<TransferOptions> sub(app, "transfer",
                                 "Gain, noise and range of a sensor from pairs of flat and dark raw files",
                                 command, transfer);
  sub.app
      ->add_option("--dark", sub->dark,
                   "Dark frames, two of each exposure one after the other, of two exposure times or more")
      ->required()
      ->type_name("FILE...");
  sub.app
      ->add_option("--lit", sub->lit, "Evenly lit frames, two of each, from weak light to beyond saturation")
      ->required()
      ->type_name("FILE...");
  sub.app->add_option("--plot", sub->plot, "Write the photon-transfer curves")->type_name("FILE.svg");
  add_max_memory(*sub.app, sub.options);
  add_json(*sub.app, sub->json);
}

void add_mtf(CLI::App& app, Command& command) {
  const Sub<MtfOptions> sub(app, "mtf", "Modulation transfer function of a slanted edge in a linear image",
                            command, mtf);
  sub.app->add_option("image", sub->image, "Film or linear picture")->required()->type_name("FILE");
  add_parsed(*sub.app, "--crop", sub->crop, parse_crop, "Pixels around the edge (default: all)",
             "X0,Y0,X1,Y1");
  sub.app->add_option("--channel", sub->channel, "Channel (default: G, else Y, else the first)")
      ->type_name("NAME");
  sub.app->add_option("--plot", sub->plot, "Write the curve")->type_name("FILE.svg");
  add_max_memory(*sub.app, sub.options);
  add_json(*sub.app, sub->json);
}

void add_lab(CLI::App& app, Command& command) {
  const Sub<LabOptions> sub(app, "lab", "Measure how a material scatters", command, lab);
  CLI::App& options = *sub.app;
  options
      .add_option("material", sub->material,
                  "Scene file and name of one of its materials, a file of one material, or its JSON")
      ->required()
      ->type_name("FILE.json[:NAME]|JSON");
  add_parsed(options, "--at", sub->at_nm, numbers_in(kMinWavelengthNm, kMaxWavelengthNm),
             "Wavelengths in standard air (default 450,550,650)", "NM[,NM...]");
  add_parsed(options, "--angle", sub->angles_deg, numbers_in(0, 89.9),
             "Angles of incidence (default 0,15,30,45,60,75,85)", "DEG[,DEG...]");
  options.add_flag("--inside", sub->inside, "Let the beam come from within");
  options.add_option("--illuminant", sub->illuminant, "Illuminant of the colours (default D65)")
      ->type_name("ILLUMINANT");
  add_parsed(options, "--observer", sub->observer, one_of<Observer>({"1931", "1964"}),
             "Standard observer (default 1931)", "1931|1964");
  add_parsed(options, "--samples", sub->samples, integer_in<int>(256, kMaxSamples),
             "Samples per angle and eight wavelengths (default 8192)", "N");
  options.add_option("--plot", sub->plot, "Write polar plots of the lobes")->type_name("FILE.svg");
  options.add_option("--map", sub->map, "Write pictures of the hemispheres")->type_name("FILE.png");
  add_max_memory(options, sub.options);
  add_json(options, sub->json);
}

}  // namespace abbe::cli
