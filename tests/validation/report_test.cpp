#include "validation/report/report.h"

#include <gtest/gtest.h>

#include <array>
#include <string>

#include <nlohmann/json.hpp>

namespace abbe {
namespace {

// One case that passes, with a picture, and one that fails.
struct Planted {
  Case good{Suite::optics, "good", "a < b", "[Born1999]", "mm", {0.5}, Computed{}};
  Case bad{Suite::colour, "bad", "off", "[CIE15]", "", {0.01, Margin::Kind::relative}, Computed{}};
  ValidationReport report{
      {"cpu", 2, "compiler", "-O3", "2026-01-01T00:00:00Z"}, "9.9", "abc", true, {}, {3, 9}};

  Planted() {
    CaseResult right{{{"x", 1, {1.25, 0}}}, good.margin, Verdict::pass, 0, 0, 2};
    right.picture = Image{1, 1, {{"R", {1}}, {"G", {0}}, {"B", {0}}}, {}};
    CaseResult wrong{{{"first", 2, {2, 0}}, {"second", 2, {3, 0}}}, bad.margin, Verdict::fail, 1, 16, 5};
    wrong.remarks.push_back({"beside", 0.125});
    report.outcomes = {{&good, right}, {&bad, wrong}};
  }
};

TEST(Report, JsonHoldsEveryFigureAndWhatIsNotCovered) {
  const Planted planted;
  const nlohmann::json json = nlohmann::json::parse(json_text(planted.report));
  EXPECT_EQ(json["cases"], 2);
  EXPECT_EQ(json["failures"], 1);
  EXPECT_EQ(json["cpu_s"], 9) << "the whole run, not the cases alone";
  EXPECT_EQ(json["wall_s"], 3);
  EXPECT_EQ(json["version"], "9.9");
  EXPECT_EQ(json["data_sha256"], "abc");
  const auto& bad = json["outcomes"].at(1);
  EXPECT_EQ(bad["suite"], "colour");
  EXPECT_FALSE(bad["passed"]);
  EXPECT_DOUBLE_EQ(bad["worst_share_of_margin"], 50);
  EXPECT_EQ(bad["figures"].at(1)["measured"], 3);
  EXPECT_EQ(bad["figures"].at(1)["deviation"], 1);
  EXPECT_DOUBLE_EQ(bad["figures"].at(1)["allowed"], 0.02);
  EXPECT_EQ(bad["remarks"].at(0)["value"], 0.125);
  EXPECT_EQ(json["not_covered"].size(), uncovered().size());
}

TEST(Report, TextNamesTheFailure) {
  const std::string text = readable_text(Planted().report);
  EXPECT_NE(text.find("FAIL"), std::string::npos);
  EXPECT_NE(text.find("1 of 2 cases pass"), std::string::npos);
  EXPECT_NE(text.find("not covered"), std::string::npos);
}

// Deviation and margin of a figure, as text and page print them.
TEST(Report, DeviationsAreToldInTheUnitOfTheirMargin) {
  const auto told = [](const Margin& margin, double reference, double measured, const std::string& unit) {
    const Case item{Suite::optics, "a", "", "", unit, margin, Computed{}};
    const Figure figure{"", reference, {measured, 0}};
    const auto [deviation, allowed] =
        deviation_text({&item, {{figure}, margin, Verdict::pass, 0, 0, 0}}, figure);
    return deviation + " of ± " + allowed;
  };
  EXPECT_EQ(told({0.01, Margin::Kind::relative}, 250, 251, "lx s"), "0.4 % of ± 1 %");
  EXPECT_EQ(told({0.002, Margin::Kind::relative}, -4, -4.002, ""), "-0.05 % of ± 0.2 %");
  EXPECT_EQ(told({1e-9, Margin::Kind::relative}, 1e6, 1e6 + 1e-4, ""), "1e-10 of ± 1e-09 relative");
  EXPECT_EQ(told({0.15}, 0, 0.016, "ΔE"), "0.016 of ± 0.15 ΔE");
  const std::string text = readable_text(Planted().report);
  EXPECT_NE(text.find("       50 %             ± 1 %     5000%"), std::string::npos) << text;
  EXPECT_NE(text.find("0.25          ± 0.5 mm       50%"), std::string::npos) << text;
  const std::string html = html_text(Planted().report);
  EXPECT_NE(html.find("50 %<div class=\"source close\">of ± 1 %"), std::string::npos);
  EXPECT_NE(html.find("<td class=\"n\">50 %</td><td class=\"n\">± 1 %</td>"), std::string::npos);
}

TEST(Report, CpuSecondsAreThoseOfTheWholeRun) {
  const Planted planted;
  EXPECT_NE(readable_text(planted.report).find("; 9.0 CPU s in all\n"), std::string::npos);
  EXPECT_NE(html_text(planted.report).find("3.0 s; 9.0 CPU s in all"), std::string::npos);
}

TEST(Report, RenderedChartsAreATable) {
  const Case first{Suite::colour, "chart-A", "", "", "ΔE", {0.15}, RenderedChart{"A", 1, 0.05}};
  const Case second{Suite::colour, "chart-D65", "", "", "ΔE", {0.15}, RenderedChart{"D65", 1, 0.05}};
  const auto result = [](double mean, double low, double high) {
    return CaseResult{
        {{"mean", 0, {mean, 0}}, {"a", 0, {high, 0}}, {"b", 0, {low, 0}}}, {0.15}, Verdict::pass, 0, 0, 0};
  };
  const std::string table =
      chart_table({{&first, result(0.00651, 0.004, 0.0159)}, {&second, result(0.005, 0, 0.0111)}});
  EXPECT_EQ(table,
            "| ΔE2000 | A | D65 |\n| --- | --- | --- |\n| mean of 24 patches | 0.007 | 0.005 |\n"
            "| worst patch | 0.016 | 0.011 |\n");
  EXPECT_EQ(chart_table({}), "");
}

TEST(Report, HtmlIsSelfContainedAndEscaped) {
  const Planted planted;
  const std::string html = html_text(planted.report);
  EXPECT_NE(html.find("a &lt; b"), std::string::npos);
  EXPECT_EQ(html.find("a < b"), std::string::npos);
  EXPECT_NE(html.find("1 of 2 cases fail"), std::string::npos);
  EXPECT_NE(html.find("src=\"data:image/png;base64,iVBORw0KGgo"), std::string::npos)
      << "the picture is within";
  EXPECT_EQ(html.find("http"), std::string::npos) << "nothing is fetched";
  EXPECT_NE(html.find(">FAIL<"), std::string::npos);
  EXPECT_NE(html.find("second"), std::string::npos) << "the worst figure is named";
  EXPECT_NE(html.find("Not covered"), std::string::npos);
}

// A film by three integrators: one passes, one cannot sample the light, and one fails.
struct PlantedCells {
  std::array<Case, 3> cells{cell(Integrator::path), cell(Integrator::light), cell(Integrator::bdpt)};
  ValidationReport report{{}, "9.9", "abc", true, {}, {3, 9}};

  PlantedCells() {
    CaseResult lost{{}, {0.01, Margin::Kind::relative}, Verdict::pass, 0, 0, 0};
    lost.unsampled = {"E L: lights seen directly (\"lamp\")"};
    report.outcomes = {
        {&cells[0], of(2.01, Verdict::pass)}, {&cells[1], lost}, {&cells[2], of(2.5, Verdict::fail)}};
    report.outcomes[2].result.owned = {"E (S|D)* L"};
  }
  static Case cell(Integrator by) {
    return {Suite::techniques,
            "film by " + std::string(kIntegratorNames.at(static_cast<std::size_t>(by))),
            "",
            "",
            "",
            {0.01, Margin::Kind::relative},
            TechniqueMean{"film", by, {"", {}, "Y", 1.0, 1, 0.002}, Tier::quick}};
  }
  static CaseResult of(double measured, Verdict verdict) {
    return {{{"", 2, {measured, 0.001}}}, {0.01, Margin::Kind::relative}, verdict, 0, 16, 1};
  }
};

TEST(Report, TechniquesAreATable) {
  const PlantedCells planted;
  const std::string text = readable_text(planted.report);
  EXPECT_NE(text.find("| film | – | +0.50 | lost 1 | FAIL +25.00 | – |"), std::string::npos) << text;
  EXPECT_NE(text.find("1. `E L`: lights seen directly (\"lamp\")\n"), std::string::npos) << text;
  EXPECT_NE(text.find("FAIL film by bdpt: +25.000 ± 0.244 % of ± 1 %, of the paths E (S|D)* L"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("1 of 2 cases pass"), std::string::npos) << "what is lost was not measured";
  const std::string html = html_text(planted.report);
  EXPECT_NE(html.find("<td class=\"n pass\">+0.50</td><td class=\"n soft\">lost 1</td>"
                      "<td class=\"n fail\">FAIL +25.00</td>"),
            std::string::npos);
  EXPECT_NE(html.find("1 of 2 cases fail"), std::string::npos);
}

TEST(Report, JsonTellsWhichTechniqueRenderedWhichFilm) {
  const nlohmann::json json = nlohmann::json::parse(json_text(PlantedCells().report));
  EXPECT_EQ(json["cases"], 2);
  EXPECT_EQ(json["failures"], 1);
  EXPECT_EQ(json["outcomes"].at(1)["film"], "film");
  EXPECT_EQ(json["outcomes"].at(1)["technique"], "light");
  EXPECT_EQ(json["outcomes"].at(1)["unreached"].size(), 1U);
  EXPECT_EQ(json["outcomes"].at(2)["paths"].at(0), "E (S|D)* L");
}

TEST(Report, OnlyTheSuitesAskedForRun) {
  std::vector<std::string> told;
  const ValidationReport report =
      validate({.suites = {Suite::camera}, .quick = true, .version = "1", .say = [&](const std::string& s) {
                  told.push_back(s);
                }});
  ASSERT_FALSE(report.outcomes.empty());
  EXPECT_EQ(told.size(), report.outcomes.size());
  for (const Outcome& outcome : report.outcomes) EXPECT_EQ(outcome.item->suite, Suite::camera);
  EXPECT_EQ(report.failures(), 0U);
  EXPECT_EQ(report.data_sha256.size(), 64U);
}

}  // namespace
}  // namespace abbe
