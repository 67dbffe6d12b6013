#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "cli/query.h"

#include "io/table.h"
#include "materials/interface/fresnel.h"
#include "sampling/angle.h"
#include "spectral/air.h"
#include "tests/cli/json_output.h"
#include "tests/cli/program.h"

namespace abbe::test {
namespace {

// Rows of a table with this value in one column, in their order.
std::map<std::string, std::vector<std::size_t>> rows_by(const ReferenceTable& table,
                                                        const std::string& column) {
  std::map<std::string, std::vector<std::size_t>> groups;
  for (std::size_t row = 0; row < table.rows(); ++row) groups[table.text(row, column)].push_back(row);
  return groups;
}

// Distinct values of a column in these rows.
std::vector<double> values(const ReferenceTable& table, const std::vector<std::size_t>& rows,
                           const std::string& column) {
  std::vector<double> all;
  for (const std::size_t row : rows) {
    const double value = table.number(row, column);
    if (all.empty() || all.back() != value) all.push_back(value);
  }
  return all;
}

// Name of a patch of a ColorChecker 24 by its number in the order of the chart, which is that of the columns
// of the table. Empty for 0.
std::string patch(const std::string& chart, double number) {
  static constexpr std::array kPatches{"dark skin",
                                       "light skin",
                                       "blue sky",
                                       "foliage",
                                       "blue flower",
                                       "bluish green",
                                       "orange",
                                       "purplish blue",
                                       "moderate red",
                                       "purple",
                                       "yellow green",
                                       "orange yellow",
                                       "blue",
                                       "green",
                                       "red",
                                       "yellow",
                                       "magenta",
                                       "cyan",
                                       "white 9.5 (.05 D)",
                                       "neutral 8 (.23 D)",
                                       "neutral 6.5 (.44 D)",
                                       "neutral 5 (.70 D)",
                                       "neutral 3.5 (1.05 D)",
                                       "black 2 (1.5 D)"};
  return number == 0 ? "" : chart + ":" + kPatches.at(static_cast<std::size_t>(number) - 1);
}

TEST(QueryIor, EveryLineOfEveryMaterial) {
  const std::array<std::pair<const char*, double>, 10> lines{{{"n_h", 404.6561},
                                                              {"n_g", 435.8343},
                                                              {"n_Fprime", 479.9914},
                                                              {"n_F", 486.1327},
                                                              {"n_e", 546.0740},
                                                              {"n_d", 587.5618},
                                                              {"n_D", 589.2938},
                                                              {"n_Cprime", 643.8469},
                                                              {"n_C", 656.2725},
                                                              {"n_r", 706.5188}}};
  const ReferenceTable table("refractive_index_lines");
  ASSERT_GT(table.rows(), 20U);
  for (std::size_t row = 0; row < table.rows(); ++row) {
    cli::IndexOptions options{table.text(row, "id"), {}};
    std::vector<double> expected;  // a formula that starts later has no value for the first lines
    for (const auto& [column, nm] : lines) {
      if (table.text(row, column).empty()) continue;
      options.at_nm.push_back(nm);
      expected.push_back(table.number(row, column));
    }
    ASSERT_GT(expected.size(), 7U);
    const json found = json_output(cli::query_ior, options);
    for (std::size_t i = 0; i < expected.size(); ++i)
      EXPECT_NEAR(found["n"][i].get<double>(), expected[i], 5.1e-8)
          << options.name << ' ' << options.at_nm[i];
  }
}

TEST(QueryIor, KeysOfTheContractAndPlainNumbersForOneWavelength) {
  const json found = json_output(cli::query_ior, {"Cr_Johnson", {550}});
  EXPECT_EQ(found["name"], "Cr_Johnson");
  EXPECT_FALSE(found["source"].get<std::string>().empty());
  EXPECT_EQ(found["medium"], "air");
  EXPECT_EQ(found["wavelength_nm"], 550);
  EXPECT_TRUE(found["n"].is_number());
  EXPECT_GT(found["k"], 3);
  EXPECT_EQ(json_output(cli::query_ior, {"water_20.0C", {550}})["medium"], "vacuum");
}

TEST(QueryIor, InternalTransmittanceOfAThickness) {
  cli::IndexOptions options{"schott/N-BK7", {300, 1100}};
  EXPECT_FALSE(json_output(cli::query_ior, options).contains("internal_transmittance"));
  options.thickness_mm = 10;
  const json ten = json_output(cli::query_ior, options);
  EXPECT_NEAR(ten["internal_transmittance"][0].get<double>(), 0.301711, 1e-6) << "as its maker tells";
  options.thickness_mm = 25;
  const json more = json_output(cli::query_ior, options);
  EXPECT_NEAR(more["internal_transmittance"][0].get<double>(),
              std::pow(ten["internal_transmittance"][0].get<double>(), 2.5), 1e-12);
}

TEST(QueryReflectance, OfACoatedSurface) {
  cli::ReflectanceOptions options{"N-BK7", {550}, {0, 60}};
  const json bare = json_output(cli::query_reflectance, options);
  EXPECT_FALSE(bare.contains("T"));
  options.coating = "MgF2:99.6";
  const json coated = json_output(cli::query_reflectance, options);
  EXPECT_NEAR(coated["R"][0].get<double>(), 0.01247, 1e-5);
  EXPECT_LT(coated["R"][1], bare["R"][1]);
  EXPECT_NEAR(coated["R"][1].get<double>() + coated["T"][1].get<double>(), 1, 1e-12);
  options.coating = "MgF2:1e-9,rutile:1e-9";
  EXPECT_NEAR(json_output(cli::query_reflectance, options)["R"][1], bare["R"][1], 1e-9);
  for (const char* wrong : {"MgF2", "MgF2:", "MgF2:-3", "MgF2:a", ":3"}) {
    options.coating = wrong;
    EXPECT_THROW(cli::query_reflectance(options), Error) << wrong;
  }
  options.coating = "MgF2:100001";  // scenes do not allow such thick films
  EXPECT_EQ(fault([&options] { (void)cli::query_reflectance(options); }, "of (0, 100000] nm"),
            ErrorCode::usage);
}

TEST(QueryList, TellsOfMatterWhereItHoldsAndWhoSaysSo) {
  const json glass = json_output(cli::query_list, {"glass"});
  ASSERT_EQ(glass["glass"].size(), 1634U);
  const auto& names = glass["glass"];
  const auto at =
      static_cast<std::size_t>(std::find(names.begin(), names.end(), "hoya/FCD1") - names.begin());
  ASSERT_LT(at, names.size());
  EXPECT_EQ(glass["low_nm"][at], 365.01);
  EXPECT_DOUBLE_EQ(glass["high_nm"][at].get<double>(), 1013.98);
  EXPECT_NE(glass["source"][at].get<std::string>().find("hoya/optical/FCD1.yml"), std::string::npos);
  testing::internal::CaptureStdout();
  EXPECT_NO_THROW(cli::query_list({"material"}));
  EXPECT_NE(testing::internal::GetCapturedStdout().find("\nAu_Johnson\t191.6-1937 nm\tP. B. Johnson"),
            std::string::npos);
  const json all = json_output(cli::query_list, {""});
  EXPECT_EQ(all["glass"].size(), 1634U);
  EXPECT_FALSE(all.contains("source"));
  testing::internal::CaptureStdout();
  EXPECT_NO_THROW(cli::query_list({""}));
  EXPECT_NE(testing::internal::GetCapturedStdout().find(
                "\nglass\n  1634 glasses of manufacturers, listed by --list glass\nilluminant\n"),
            std::string::npos);
}

TEST(QueryPrism, EveryMinimumDeviation) {
  const ReferenceTable table("prism_minimum_deviation");
  for (const auto& [id, rows] : rows_by(table, "id")) {
    const json found = json_output(cli::query_prism, {id, 60, values(table, rows, "wavelength_nm"), {}});
    for (std::size_t i = 0; i < rows.size(); ++i) {
      ASSERT_EQ(table.number(rows[i], "apex_deg"), 60);
      EXPECT_NEAR(found["n"][i].get<double>(), table.number(rows[i], "n"), 5.1e-8);
      EXPECT_NEAR(found["incidence_deg"][i].get<double>(), table.number(rows[i], "incidence_deg"), 5.1e-7);
      EXPECT_NEAR(found["deviation_deg"][i].get<double>(), table.number(rows[i], "min_deviation_deg"),
                  5.1e-7);
    }
  }
}

TEST(QueryPrism, FixedIncidence) {
  const json all = json_output(cli::query_prism, {"N-BK7", 60, {656.2725, 587.5618, 486.1327, 404.6561}, 50});
  const std::array expected{38.43841, 38.65364, 39.14097, 39.83544};
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_NEAR(all["deviation_deg"][i].get<double>(), expected[i], 1e-5);
}

TEST(QueryPrism, SmallestIncidenceThatIsTransmitted) {
  const std::array<std::pair<double, double>, 3> edges{
      {{656.2725, 29.00097}, {587.5618, 29.18821}, {486.1327, 29.61000}}};
  for (const auto& [nm, edge] : edges) {
    const auto at = [nm = nm](double incidence) {
      return json_output(cli::query_prism, {"N-BK7", 60, {nm}, incidence})["deviation_deg"];
    };
    EXPECT_TRUE(at(edge - 1e-5).is_null()) << nm;
    EXPECT_TRUE(at(edge + 1e-5).is_number()) << nm;
  }
}

TEST(QueryPrism, ThroughputOfBothPolarisations) {
  const json found = json_output(cli::query_prism, {"N-BK7", 60, {587.5618}, {}});
  EXPECT_NEAR(found["Ts"].get<double>(), 0.786084, 1e-6);
  EXPECT_NEAR(found["Tp"].get<double>(), 0.991278, 1e-6);
}

// The reference assumes a medium of index 1 around the catalogued index. The index of water is relative to
// vacuum: in air, sines and tangents of its angles change by the index of air, and its reflectances are those
// of n / n_air.
TEST(QueryAngles, EveryCriticalAngleBrewsterAngleAndReflectance) {
  const ReferenceTable table("critical_brewster_fresnel");
  const std::vector<double> angles{0, 30, 45, 60, 75, 85};
  for (const auto& [id, rows] : rows_by(table, "id")) {
    const std::vector<double> at = values(table, rows, "wavelength_nm");
    const bool absolute = json_output(cli::query_ior, {id, {550}})["medium"] == "vacuum";
    const json critical = json_output(cli::query_critical, {id, at});
    const json brewster = json_output(cli::query_brewster, {id, at});
    const json reflectance = json_output(cli::query_reflectance, {id, at, angles});
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const double air = absolute ? air_index(at[i]) : 1;
      const double sine = air * std::sin(table.number(rows[i], "critical_deg") * kDegree);
      const double tangent = std::tan(table.number(rows[i], "brewster_outside_deg") * kDegree) / air;
      EXPECT_NEAR(critical["angle_deg"][i], std::asin(sine) / kDegree, 5.1e-7) << id;
      EXPECT_NEAR(brewster["angle_deg"][i], std::atan(tangent) / kDegree, 5.1e-7) << id;
      for (std::size_t a = 0; a < angles.size(); ++a) {
        const FresnelPower<double> in_air =
            fresnel_dielectric(std::cos(angles[a] * kDegree), table.number(rows[i], "n") / air);
        for (const std::string kind : {"Rs", "Rp"})
          EXPECT_NEAR(reflectance[kind][i][a].get<double>(),
                      absolute ? (kind == "Rs" ? in_air.Rs : in_air.Rp)
                               : table.number(rows[i], fmt::format("{}_{}", kind, angles[a])),
                      absolute ? 5e-8 : 5.1e-9)
              << id << ' ' << kind << ' ' << angles[a];
      }
    }
  }
}

TEST(QueryReflectance, EveryMetal) {
  const ReferenceTable table("metal_reflectance");
  for (const auto& [name, rows] : rows_by(table, "name")) {
    const std::vector<double> at_nm = values(table, rows, "wavelength_nm");
    const json found = json_output(cli::query_reflectance, {name, at_nm, {0, 45, 75}});
    for (std::size_t i = 0; i < rows.size(); ++i) {
      ASSERT_EQ(found["wavelength_nm"][i / 3], table.number(rows[i], "wavelength_nm"));
      ASSERT_EQ(found["angle_deg"][i % 3], table.number(rows[i], "theta_deg"));
      EXPECT_NEAR(found["Rs"][i / 3][i % 3].get<double>(), table.number(rows[i], "Rs"), 5.1e-9);
      EXPECT_NEAR(found["Rp"][i / 3][i % 3].get<double>(), table.number(rows[i], "Rp"), 5.1e-9);
      EXPECT_NEAR(found["R"][i / 3][i % 3].get<double>(), table.number(rows[i], "R_unpol"), 5.1e-9);
    }
  }
}

TEST(QueryReflectance, ShapeFollowsTheQuestion) {
  EXPECT_TRUE(json_output(cli::query_reflectance, {"Al_Rakic", {550}, {60}})["R"].is_number());
  EXPECT_EQ(json_output(cli::query_reflectance, {"Al_Rakic", {550}, {0, 60, 80}})["R"].size(), 3U);
  EXPECT_EQ(json_output(cli::query_reflectance, {"Al_Rakic", {500, 550}, {60}})["R"].size(), 2U);
  const json full = json_output(cli::query_reflectance, {"Al_Rakic", {500, 550}, {0, 60, 90}})["R"];
  EXPECT_EQ(full.size(), 2U);
  EXPECT_EQ(full[0].size(), 3U);
  EXPECT_EQ(full[1][2], 1);
}

TEST(QueryColor, EveryWhitePointOfBothObservers) {
  const ReferenceTable table("white_points");
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const Observer observer = table.text(row, "observer") == "2" ? Observer::cie1931 : Observer::cie1964;
    const json found = json_output(cli::query_color, {table.text(row, "illuminant"), observer, ""});
    EXPECT_NEAR(found["xy"][0].get<double>(), table.number(row, "x_360_830"), 5.1e-7)
        << table.text(row, "illuminant");
    EXPECT_NEAR(found["xy"][1].get<double>(), table.number(row, "y_360_830"), 5.1e-7)
        << table.text(row, "illuminant");
    EXPECT_NEAR(found["XYZ"][1].get<double>(), 100, 1e-12);
    EXPECT_NEAR(found["Lab"][0].get<double>(), 100, 1e-12);
  }
}

TEST(QueryColor, EveryPatchOfTheChart) {
  const ReferenceTable table("colorchecker_babelcolor_360_830");
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const json found = json_output(cli::query_color,
                                   {table.text(row, "illuminant"), Observer::cie1931,
                                    patch("colorchecker24_babelcolor_average", table.number(row, "index"))});
    const std::array columns{"X", "Y", "Z", "L", "a", "b"};
    for (std::size_t i = 0; i < 6; ++i)
      EXPECT_NEAR(found[i < 3 ? "XYZ" : "Lab"][i % 3].get<double>(), table.number(row, columns[i]), 1e-5)
          << table.text(row, "patch") << ' ' << columns[i];
  }
}

TEST(QueryColor, ByTheWeightsOfAstmE308) {
  const ReferenceTable table("colorchecker_babelcolor_2deg");
  const auto by = [](const std::string& light, const std::string& reflectance, cli::ColorMethod method) {
    return json_output(cli::query_color, {light, Observer::cie1931, reflectance, true, method});
  };
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const std::string& light = table.text(row, "illuminant");
    if (light.starts_with("FL")) continue;  // see tests/spectral/astm_e308_test.cpp
    const json found = by(light, patch("colorchecker24_babelcolor_average", table.number(row, "index")),
                          cli::ColorMethod::astm_e308);
    EXPECT_EQ(found["method"], "astm-e308");
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(found["Lab"][i].get<double>(), table.number(row, std::string(1, "Lab"[i]) + "_E308"),
                  5.1e-6)
          << light << ' ' << table.text(row, "patch");
  }
  const json white = by("D65", "", cli::ColorMethod::astm_e308);
  EXPECT_NEAR(white["XYZ"][1].get<double>(), 100, 1e-12);
  EXPECT_NEAR(white["Lab"][0].get<double>(), 100, 1e-12);
  EXPECT_FALSE(by("D65", "", cli::ColorMethod::one_nm).contains("method"));
  EXPECT_EQ(fault(
                [] {
                  cli::query_color({"D65", Observer::cie1931, "colorchecker24_ohta1997:blue", true,
                                    cli::ColorMethod::astm_e308});
                },
                "every 10 or 20 nm at whole steps from 360 nm (got 5 nm)"),
            ErrorCode::input);
}

TEST(QueryColor, SumsOverTheRangeThatIsChosen) {
  const auto xy = [](const std::string& arguments) {
    const Outcome run = abbe("query color --illuminant D65 --json" + arguments);
    EXPECT_EQ(run.code, 0) << run.err;
    return run.json()["xy"].get<Chromaticity>();
  };
  for (const auto& [arguments, x, y] : {std::tuple{"", 0.312727, 0.329023},
                                        {" --range 360-830", 0.312727, 0.329023},
                                        {" --range 380-780", 0.312739, 0.329052}}) {
    EXPECT_NEAR(xy(arguments)[0], x, 6e-7) << arguments;
    EXPECT_NEAR(xy(arguments)[1], y, 6e-7) << arguments;
  }
  const Outcome other = abbe("query color --illuminant D65 --range 400-700");
  EXPECT_EQ(other.code, 2);
  EXPECT_NE(other.err.find("allowed 360-830, 380-780"), std::string::npos) << other.err;
  const Outcome astm = abbe("query color --illuminant D65 --range 380-780 --method astm-e308");
  EXPECT_EQ(astm.code, 2);
  EXPECT_NE(astm.err.find("--range: applies to --method 1nm only"), std::string::npos) << astm.err;
}

TEST(QueryArrays, OneWavelengthIsAListOnlyWhereListsWereAskedFor) {
  cli::IndexOptions index{"N-BK7", {550}, true, 10.0};
  cli::ReflectanceOptions surface{"N-BK7", {550}, {60}, true};
  cli::PrismOptions prism{"N-BK7", 60, {550}, {}, true};
  const auto all = [&] {
    json answers{{"ior", json_output(cli::query_ior, index)},
                 {"critical", json_output(cli::query_critical, index)},
                 {"brewster", json_output(cli::query_brewster, index)},
                 {"reflectance", json_output(cli::query_reflectance, surface)},
                 {"prism", json_output(cli::query_prism, prism)}};
    return answers.flatten();
  };
  const json plain = all();
  index.arrays = surface.arrays = prism.arrays = true;
  const json lists = all();
  EXPECT_EQ(plain.size(), lists.size());
  std::size_t longer = 0;
  for (const auto& [pointer, value] : plain.items()) {
    const bool nested = pointer.starts_with("/reflectance/R") || pointer.starts_with("/reflectance/phase");
    const std::string listed = pointer + (nested ? "/0/0" : "/0");
    if (lists.contains(listed)) ++longer;
    EXPECT_EQ(lists.contains(listed) ? lists[listed] : lists.value(pointer, json()), value) << pointer;
  }
  EXPECT_EQ(longer, 4U + 2U + 4U + 7U + 6U);
}

TEST(QueryDeltaE, PublishedPair) {
  const json found = json_output(cli::query_delta_e, {{50, 2.6772, -79.7751}, {50, 0, -82.7485}});
  EXPECT_NEAR(found["dE00"].get<double>(), 2.0425, 5e-5);
  EXPECT_NEAR(found["dE76"].get<double>(), std::hypot(2.6772, 2.9734), 1e-12);
  EXPECT_TRUE(found.contains("dE94"));
}

TEST(QueryCamera, EveryPatchOfEveryChart) {
  const ReferenceTable table("camera_raw_colorchecker");
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const json raw = json_output(cli::query_camera,
                                 {table.text(row, "camera"), table.text(row, "illuminant"),
                                  patch(table.text(row, "spectra"), table.number(row, "index"))})["raw"];
    for (const std::string channel : {"R", "G", "B"})
      EXPECT_NEAR(raw[channel].get<double>(), table.number(row, "raw_" + channel), 5.1e-8)
          << table.text(row, "patch") << ' ' << channel;
  }
}

TEST(QueryList, NamesEveryKind) {
  const json all = json_output(cli::query_list, cli::ListOptions{});
  EXPECT_EQ(all.size(), 7U);
  const auto names = all["material"].get<std::vector<std::string>>();
  EXPECT_NE(std::find(names.begin(), names.end(), "N-BK7"), names.end());
  EXPECT_EQ(json_output(cli::query_list, {"camera"}).size(), 1U);
}

TEST(QueryFaults, UnknownNamesAreMissingInputsAndSuggestTheNearest) {
  EXPECT_EQ(fault([] { cli::query_ior({"N-BK8", {550}}); }, "N-BK7"), ErrorCode::input);
  EXPECT_EQ(fault([] { cli::query_color({"ID6", Observer::cie1931, ""}); }, "ID65"), ErrorCode::input);
  EXPECT_EQ(fault([] { cli::query_camera({"Nikon_D5101", "D65", ""}); }, "Nikon_D5100"), ErrorCode::input);
  EXPECT_EQ(fault(
                [] {
                  cli::query_color({"D65", Observer::cie1931, "missing.csv:a"});
                },
                "missing.csv"),
            ErrorCode::input);
  EXPECT_EQ(fault([] { cli::query_list({"illuminent"}); }, "illuminant"), ErrorCode::usage);
}

TEST(QueryFaults, AReflectanceIsAShare) {
  const auto table = scratch().write(
      "percent.csv",
      "# title: card\n# unit: percent\n# source: here\n# status: made up\n# processing: none\n"
      "# outside: clamp\nwavelength_nm,a\n400,10\n700,50\n");
  EXPECT_EQ(fault(
                [&] {
                  cli::query_color({"D65", Observer::cie1931, table.string() + ":a"});
                },
                "curve out of range at 300 nm (got 10, allowed [0, 1])"),
            ErrorCode::input);
}

TEST(QueryFaults, WavelengthsWithoutDataAreUsageErrorsThatSayTheRange) {
  EXPECT_EQ(fault(
                [] {
                  cli::query_ior({"Au_Johnson", {550, 250}});
                },
                "got 250 nm, allowed [300, 1100] nm"),
            ErrorCode::usage);
  EXPECT_EQ(fault(
                [] {
                  cli::query_brewster({"PMMA", {404.6561}});
                },
                "got 404.6561 nm, allowed [436.8, 1052] nm"),
            ErrorCode::usage);
}

}  // namespace
}  // namespace abbe::test
