// Self-contained HTML report with style, plots and pictures.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "io/picture.h"
#include "io/text.h"
#include "report/svg.h"
#include "validation/report/report.h"
#include "validation/statistics.h"

namespace abbe {
namespace {

constexpr const char* kStyle = R"(
:root { --ink: #1c2430; --soft: #5b6675; --line: #d9dee6; --pass: #1b7f4b; --fail: #b3261e; }
body { font: 15px/1.5 system-ui, "Segoe UI", "DejaVu Sans", sans-serif; color: var(--ink); margin: 0 auto;
  max-width: 1120px; padding: 28px 24px 60px; background: #fff; }
h1 { font-size: 27px; margin: 0 0 4px; }
h2 { font-size: 20px; margin: 40px 0 8px; border-bottom: 2px solid var(--ink); padding-bottom: 3px; }
h2::first-letter { text-transform: uppercase; }
h3 { font-size: 16px; margin: 24px 0 6px; }
p { margin: 6px 0; }
a { color: inherit; }
.soft, .source { color: var(--soft); }
.source { font-size: 12.5px; white-space: normal; }
.close { white-space: nowrap; }
.verdict { font-size: 18px; font-weight: 600; padding: 9px 14px; border-radius: 6px; margin: 14px 0; color: #fff; }
.verdict.pass { background: var(--pass); }
.verdict.fail { background: var(--fail); }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; }
th { text-align: left; font-weight: 600; border-bottom: 1px solid var(--ink); padding: 3px 10px 3px 0;
  vertical-align: bottom; }
td { border-bottom: 1px solid var(--line); padding: 5px 10px 5px 0; vertical-align: top; }
td.n, th.n { text-align: right; white-space: nowrap; }
td.pass { color: var(--pass); font-weight: 600; }
td.fail, .failure { color: var(--fail); font-weight: 700; }
.matrix { font-size: 12.5px; }
.matrix td { padding: 2px 8px 2px 0; font-weight: 400; }
.matrix td.fail { font-weight: 700; }
td.case { width: 36%; }
.figures { display: grid; grid-template-columns: repeat(auto-fill, minmax(150px, 1fr)); gap: 16px; margin: 10px 0; }
.figures.large { grid-template-columns: repeat(auto-fill, minmax(320px, 1fr)); }
figure { margin: 0; break-inside: avoid; }
figure img { width: 100%; height: auto; image-rendering: pixelated; border: 1px solid var(--line);
  display: block; }
figcaption { font-size: 12.5px; color: var(--soft); margin-top: 3px; }
details { margin: 2px 0; font-size: 13px; }
summary { cursor: pointer; color: var(--soft); }
dl { display: grid; grid-template-columns: max-content 1fr; gap: 1px 14px; margin: 12px 0; font-size: 13.5px; }
dt { color: var(--soft); }
dd { margin: 0; overflow-wrap: anywhere; }
tr { break-inside: avoid; }
h2, h3 { break-after: avoid; }
@media print {
  body { font-size: 10.5px; max-width: none; padding: 0; }
  details:not([open]) { display: none; }
  * { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
}
)";

constexpr double kMarginBarWidth = 220;
constexpr double kMarginBarHeight = 24;
constexpr double kBarRange = 1.25;  // half width of a bar in margins

double bar_at(double margins) {
  return kMarginBarWidth / 2 * (1 + std::clamp(margins, -kBarRange, kBarRange) / kBarRange);
}

// Mark of figure number `i` in a bar: a dot at its deviation, and a line for the interval of a sampled
// figure. Many dots are spread vertically to show their density.
std::string bar_mark(const CaseResult& result, std::size_t i) {
  constexpr std::size_t kFew = 12;
  constexpr double kGolden = 0.6180339887;
  const Figure& figure = result.figures[i];
  const bool many = result.figures.size() > kFew;
  const double allowed = result.allowed(figure);
  const double margins = figure.deviation() / allowed;
  const double spread = kInterval * figure.measured.standard_error / allowed;
  const bool outside = !(std::abs(margins) <= 1);
  const double jitter = many ? std::fmod(static_cast<double>(i) * kGolden, 1.0) - 0.5 : 0;
  const double y = kMarginBarHeight / 2 + jitter * (kMarginBarHeight - 10);
  const std::string line = spread > 0 ? svg_line(bar_at(margins - spread), y, bar_at(margins + spread), y,
                                                 "stroke=\"#1f4e8c\" stroke-width=\"1.6\"")
                                      : "";
  const double radius = outside ? 4 : many ? 1.6 : 3;
  return line + svg_circle(bar_at(std::isfinite(margins) ? margins : kBarRange), y, radius,
                           fmt::format("fill=\"{}\" fill-opacity=\"{}\"", outside ? "#b3261e" : "#1f4e8c",
                                       many && !outside ? 0.5 : 0.9));
}

// All figures of a case relative to the band of their margin.
std::string margin_bar(const CaseResult& result) {
  std::string all = svg_rect(bar_at(-1), 2, bar_at(1) - bar_at(-1), kMarginBarHeight - 4, "fill=\"#e3f2ea\"");
  for (const double edge : {-1.0, 0.0, 1.0})
    all += svg_line(bar_at(edge), 2, bar_at(edge), kMarginBarHeight - 2,
                    edge == 0 ? "stroke=\"#9aa5b1\"" : "stroke=\"#1b7f4b\"");
  for (std::size_t i = 0; i < result.figures.size(); ++i) all += bar_mark(result, i);
  return svg_picture(kMarginBarWidth, kMarginBarHeight, all);
}

std::string number(double value) {
  return fmt::format("{:.8g}", value);
}

// Table of the figures, sorted by deviation in units of the margin, the largest first.
std::string figure_details(const Outcome& outcome) {
  const CaseResult& result = outcome.result;
  constexpr std::size_t kMaxFigures = 24;
  if (result.figures.size() < 2) return "";
  std::vector<const Figure*> figures;
  for (const Figure& figure : result.figures) figures.push_back(&figure);
  std::ranges::stable_sort(figures, [&](const Figure* a, const Figure* b) {
    return std::abs(a->deviation()) / result.allowed(*a) > std::abs(b->deviation()) / result.allowed(*b);
  });
  const std::size_t listed = std::min(kMaxFigures, figures.size());
  std::string all = fmt::format(
      "<details><summary>{}</summary><table><tr><th></th><th class=\"n\">value</th>"
      "<th class=\"n\">reference</th><th class=\"n\">deviation</th><th class=\"n\">margin</th></tr>",
      listed == figures.size()
          ? fmt::format("all {} figures", listed)
          : fmt::format("the {} of {} figures with the largest deviations", listed, figures.size()));
  for (std::size_t i = 0; i < listed; ++i) {
    const auto [deviation, margin] = deviation_text(outcome, *figures[i]);
    all += fmt::format(
        "<tr><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td>"
        "<td class=\"n\">± {}</td></tr>",
        escaped(figures[i]->what), number(figures[i]->measured.mean), number(figures[i]->reference),
        deviation, escaped(margin));
  }
  return all + "</table></details>";
}

std::string remark_details(const CaseResult& result) {
  if (result.remarks.empty()) return "";
  std::string all = "<details open><summary>reported without a verdict</summary><table>";
  for (const Remark& remark : result.remarks)
    all += fmt::format("<tr><td>{}</td><td class=\"n\">{:.3f}</td></tr>", escaped(remark.what), remark.value);
  return all + "</table></details>";
}

std::string worst_cells(const Outcome& outcome) {
  const CaseResult& result = outcome.result;
  if (result.figures.empty()) return "<td></td><td></td><td>no figures</td>";
  const Figure& worst = result.figures[result.worst];
  const std::string cost =
      result.samples > 0 ? fmt::format("<br>{} spp, {:.1f} CPU s", result.samples, result.cpu_s) : "";
  const auto [deviation, margin] = deviation_text(outcome, worst);
  return fmt::format(
      "<td class=\"n\">{}<div class=\"source\">{}</div></td>"
      "<td class=\"n\">{}<div class=\"source\">{}</div></td>"
      "<td class=\"n\">{}<div class=\"source close\">of ± {}{}</div></td>",
      number(worst.measured.mean), escaped(worst.what), number(worst.reference), escaped(outcome.item->unit),
      deviation, escaped(margin), cost);
}

std::string case_row(const Outcome& outcome) {
  const Case& item = *outcome.item;
  const CaseResult& result = outcome.result;
  return fmt::format(
      "<tr><td class=\"case\"><b>{}</b> {}<div class=\"source\">{}</div>{}{}</td>{}<td>{}</td>"
      "<td class=\"{}\">{}</td></tr>\n",
      escaped(item.id), escaped(item.title), escaped(item.source), figure_details(outcome),
      remark_details(result), worst_cells(outcome), margin_bar(result), result.passed() ? "pass" : "fail",
      verdict_name(result.verdict));
}

std::string picture(const Image& image, const std::string& caption) {
  return fmt::format(
      "<figure><img alt=\"{0}\" width=\"{1}\" height=\"{2}\" src=\"data:image/png;base64,{3}\">"
      "<figcaption>{0}</figcaption></figure>\n",
      escaped(caption), image.width, image.height, base64(encoded_picture(".png", image)));
}

std::string chart_caption(const RenderedChart& chart, const CaseResult& result) {
  const ChartSummary summary = chart_summary(result);
  return fmt::format("{}: ΔE2000 {:.3f} in mean, {:.3f} at most", chart.illuminant, summary.mean,
                     summary.worst);
}

std::string suite_pictures(const ValidationReport& report, Suite suite) {
  std::string charts;
  std::string maps;
  for (const Outcome& outcome : report.outcomes) {
    if (outcome.item->suite != suite || !outcome.result.picture) continue;
    if (const auto* chart = std::get_if<RenderedChart>(&outcome.item->method))
      charts += picture(*outcome.result.picture, chart_caption(*chart, outcome.result));
    else
      maps += picture(*outcome.result.picture, outcome.item->id + ": " + outcome.item->title);
  }
  std::string all;
  if (!charts.empty()) all += "<h3>Rendered charts</h3><div class=\"figures large\">" + charts + "</div>";
  if (!maps.empty())
    all +=
        "<h3>Rendered films</h3><p class=\"soft\">From zero (dark) to twice the expected mean "
        "(bright).</p><div class=\"figures\">" +
        maps + "</div>";
  return all;
}

std::string suite_section(const ValidationReport& report, Suite suite) {
  if (suite == Suite::techniques) {
    const std::string matrix = technique_table_html(report.outcomes);
    return matrix.empty() ? "" : fmt::format("<h2 id=\"{0}\">{0}</h2>\n", suite_name(suite)) + matrix;
  }
  std::string rows;
  for (const Outcome& outcome : report.outcomes)
    if (outcome.item->suite == suite) rows += case_row(outcome);
  if (rows.empty()) return "";
  return fmt::format(
             "<h2 id=\"{0}\">{0}</h2>\n<table><tr><th>case</th><th class=\"n\">worst figure</th>"
             "<th class=\"n\">reference</th><th class=\"n\">deviation</th>"
             "<th>all figures within the margin</th><th></th></tr>\n",
             suite_name(suite)) +
         rows + "</table>\n" + suite_pictures(report, suite);
}

std::string summary_row(const ValidationReport& report, Suite suite) {
  std::size_t cases = 0;
  std::size_t passed = 0;
  std::size_t figures = 0;
  double worst = 0;
  double cpu_s = 0;
  for (const Outcome& outcome : report.outcomes) {
    if (outcome.item->suite != suite || !outcome.result.measured()) continue;
    ++cases;
    passed += outcome.result.passed() ? 1 : 0;
    figures += outcome.result.figures.size();
    worst = std::max(worst, worst_margin_ratio(outcome.result));
    cpu_s += outcome.result.cpu_s;
  }
  if (cases == 0) return "";
  return fmt::format(
      "<tr><td><a href=\"#{0}\">{0}</a></td><td class=\"n\">{1}</td><td class=\"n\">{2}</td>"
      "<td class=\"n {6}\">{3}</td><td class=\"n\">{4:.0f} %</td><td class=\"n\">{5:.1f}</td></tr>\n",
      suite_name(suite), cases, figures, passed, 100 * worst, cpu_s, passed == cases ? "pass" : "fail");
}

std::string run_details(const ValidationReport& report) {
  const Machine& machine = report.machine;
  return fmt::format(
      "<dl><dt>run</dt><dd>{}</dd><dt>machine</dt><dd>{}, {} processors</dd><dt>compiler</dt><dd>{} {}</dd>"
      "<dt>date</dt><dd>{}</dd><dt>run time</dt><dd>{:.1f} s; {:.1f} CPU s in all</dd>"
      "<dt>data</dt><dd>SHA-256 {}</dd></dl>\n",
      report.quick ? "quick, films at the margins of the tests" : "full, films at their fine margins",
      escaped(machine.cpu), machine.cores, escaped(machine.compiler), escaped(machine.flags), machine.date,
      report.cost.wall_s, report.cost.cpu_s, report.data_sha256);
}

std::string summary(const ValidationReport& report) {
  const std::size_t failed = report.failures();
  const std::size_t cases = report.outcomes.size() - report.unsampled();
  std::string all = fmt::format("<h1>Abbe {}: validation</h1>\n<div class=\"verdict {}\">{}</div>\n",
                                escaped(report.version), failed == 0 ? "pass" : "fail",
                                failed == 0 ? fmt::format("All {} cases pass", cases)
                                            : fmt::format("{} of {} cases fail", failed, cases));
  all +=
      "<table><tr><th>suite</th><th class=\"n\">cases</th><th class=\"n\">figures</th>"
      "<th class=\"n\">cases passed</th><th class=\"n\">worst figure, of its margin</th>"
      "<th class=\"n\">CPU s</th></tr>\n";
  for (std::size_t i = 0; i < kSuiteNames.size(); ++i) all += summary_row(report, static_cast<Suite>(i));
  return all + "</table>\n" + run_details(report);
}

std::string gaps() {
  std::string all = "<h2>Not covered</h2>\n<table><tr><th>suite</th><th>what</th><th>reason</th></tr>\n";
  for (const Uncovered& gap : uncovered())
    all += fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td></tr>\n", suite_name(gap.suite),
                       escaped(gap.what), escaped(gap.reason));
  return all + "</table>\n";
}

}  // namespace

std::string html_text(const ValidationReport& report) {
  std::string all = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Abbe {}: validation</title>\n"
      "<meta name=\"viewport\" content=\"width=device-width\"><link rel=\"icon\" href=\"data:,\">"
      "<style>{}</style></head><body>\n",
      escaped(report.version), kStyle);
  all += summary(report);
  for (std::size_t i = 0; i < kSuiteNames.size(); ++i) all += suite_section(report, static_cast<Suite>(i));
  return all + gaps() +
         fmt::format(
             "<p class=\"soft\">A case passes when all its figures are within their margins; a sampled "
             "figure "
             "with its whole interval of ± {:g} standard errors. Many margins are half the last digit that "
             "the "
             "reference prints, so that the worst of many figures comes near. Keys in brackets are those of "
             "docs/references.bib.</p>\n</body></html>\n",
             kInterval);
}

}  // namespace abbe
