#include <cmath>
#include <sstream>

#include <gtest/gtest.h>
#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>

#include "tests/validation/bench_runs.h"

namespace abbe {
namespace {

using Tree = boost::property_tree::ptree;

// Elements of an SVG document with this tag and class. Throws if it is not well-formed.
std::vector<Tree> elements(const std::string& document, const std::string& tag, const std::string& kind) {
  std::istringstream stream(document);
  Tree tree;
  read_xml(stream, tree);
  std::vector<Tree> found;
  for (const auto& [name, child] : tree.get_child("svg"))
    if (name == tag && child.get("<xmlattr>.class", "") == kind) found.push_back(child);
  return found;
}

double attribute(const Tree& element, const std::string& name) {
  return element.get<double>("<xmlattr>." + name);
}

// Pixel coordinate of a value, from the tick labels at 1 and 10 of an axis.
double position(const std::string& document, const std::string& axis, double value) {
  const auto tick = [&](const std::string& label) {
    for (const Tree& text : elements(document, "text", axis))
      if (text.data() == label) return attribute(text, axis);
    throw Error(ErrorCode::internal, axis, "no tick " + label);
  };
  const double one = tick("1");
  return one + (tick("10") - one) * std::log10(value);
}

LogPlot two_decades() {
  return {"A & B <plot>",
          "x",
          "y",
          {{"\"ours\"", {{1, 1}, {10, 50}, {20, 10}}, "#d62728"}, {"rival", {{2, 3}}, "#1f77b4"}}};
}

TEST(BenchPlot, MarkersStandWhereTheLogarithmicAxesSay) {
  const std::string document = svg(two_decades());
  const std::vector<Tree> points = elements(document, "circle", "point");
  ASSERT_EQ(points.size(), 4U);
  const std::vector<std::pair<double, double>> expected{{1, 1}, {10, 50}, {20, 10}, {2, 3}};
  const double label_drop = 4;  // offset of the tick labels of y from the centre of their line
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(attribute(points[i], "cx"), position(document, "x", expected[i].first), 0.02) << i;
    EXPECT_NEAR(attribute(points[i], "cy") + label_drop, position(document, "y", expected[i].second), 0.02)
        << i;
  }
  EXPECT_GT(attribute(points[2], "cx"), attribute(points[0], "cx"));
  EXPECT_LT(attribute(points[2], "cy"), attribute(points[0], "cy")) << "larger values stand higher";
}

TEST(BenchPlot, TheLegendNamesEverySeriesAndTextIsEscaped) {
  const std::string document = svg(two_decades());
  EXPECT_EQ(elements(document, "circle", "key").size(), 2U);
  std::string texts;
  for (const Tree& text : elements(document, "text", "")) texts += text.data() + ";";
  EXPECT_NE(texts.find("A & B <plot>;"), std::string::npos) << texts;
  EXPECT_NE(texts.find("\"ours\";rival;"), std::string::npos) << texts;
}

TEST(BenchPlot, RangesEndOnStepsOfOneTwoFive) {
  EXPECT_EQ(log_range({}), std::pair(1.0, 10.0));
  const auto [low, high] = log_range({0.03, 1.7, 6});
  EXPECT_NEAR(low, 0.02, 1e-12);
  EXPECT_NEAR(high, 10, 1e-12);
  const auto [at, next] = log_range({5, 5});
  EXPECT_NEAR(at, 5, 1e-12);
  EXPECT_NEAR(next, 10, 1e-12);
}

TEST(BenchPlot, ASuiteShowsItsCurvesAndItsRivals) {
  const BenchReport report = test::planned_report();
  const LogPlot plot = error_plot(report.runs.front(), report.other_renderers);
  ASSERT_EQ(plot.series.size(), 4U);
  EXPECT_EQ(plot.series[0].name, "Abbe auto, floor 0.01");
  ASSERT_EQ(plot.series[0].points.size(), 3U);
  EXPECT_NEAR(plot.series[0].points[1].first, 1.6, 1e-12);
  EXPECT_NEAR(plot.series[0].points[1].second, 0.2, 1e-12);
  EXPECT_EQ(plot.series[1].name, "other path");
  EXPECT_EQ(plot.series[1].points, (std::vector<std::pair<double, double>>{{5, 0.2}}));
  EXPECT_EQ(plot.series[2].name, "Abbe auto, floor 0.0025");
  EXPECT_NEAR(plot.series[2].points[1].second, 0.4, 1e-12);
  EXPECT_EQ(plot.series[3].name, "third path");
}

}  // namespace
}  // namespace abbe
