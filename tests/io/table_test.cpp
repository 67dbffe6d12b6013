#include "io/table.h"

#include <gtest/gtest.h>

#include "io/data_directory.h"
#include "io/text.h"
#include "test_files.h"

namespace abbe {
namespace {

const std::string kHead =
    "# title: T\n# unit: 1\n# source: S, 2020: page 3\n# status: published numbers\n# processing: none\n";

std::optional<Table> table_of(const std::string& text, TableOrigin origin, Diagnostics& diagnostics) {
  const auto path = test_folder() / "t.csv";
  put(path, text);
  return read_table(path, origin, diagnostics);
}

/// The complaints about a table, first lines only and without the path.
std::string complaints(const std::string& text, TableOrigin origin) {
  Diagnostics diagnostics;
  EXPECT_FALSE(table_of(text, origin, diagnostics).has_value());
  std::string all;
  for (const Diagnostic& diagnostic : diagnostics.all()) {
    EXPECT_EQ(diagnostic.code, ErrorCode::input);
    const std::string line = format(diagnostic);
    const std::size_t begin = line.find("t.csv:") + 6;
    all += line.substr(begin, line.find('\n') - begin) + '\n';
  }
  return all;
}

TEST(Table, ReadsHeaderAndRows) {
  Diagnostics diagnostics;
  const auto table =
      table_of(kHead +
                   "# outside: zero\n# medium: air\n\nwavelength_nm, a ,\"b, \"\"c\"\"\"\n400,1e-3,x\r\n"
                   "# a remark: skipped\n\n500, 2 ,\" y,z \"\n",
               TableOrigin::shipped, diagnostics);
  ASSERT_TRUE(table.has_value()) << diagnostics.text();
  EXPECT_EQ(table->provenance.title, "T");
  EXPECT_EQ(table->provenance.source, "S, 2020: page 3");
  EXPECT_EQ(table->keys.at("medium"), "air");
  EXPECT_EQ(table->keys.size(), 7U);
  EXPECT_EQ(table->outside, Outside::zero);
  EXPECT_EQ(table->columns, (std::vector<std::string>{"wavelength_nm", "a", "b, \"c\""}));
  ASSERT_EQ(table->rows.size(), 2U);
  EXPECT_EQ(table->rows[1], (std::vector<std::string>{"500", "2", " y,z "}));
  EXPECT_EQ(table->numbers(*table->column("a"), diagnostics), (std::vector<double>{0.001, 2}));
  EXPECT_EQ(table->column("x"), std::nullopt);
  EXPECT_EQ(table->where.source->text.substr(table->position(1).offset, 3), "500");
}

TEST(Table, ShippedTablesCarryTheirProvenance) {
  EXPECT_EQ(complaints("# title: T\n# unit:\nl,a\n1,2\n", TableOrigin::shipped),
            "1:1: error: missing unit; add a line \"# unit: <unit>\"\n"
            "1:1: error: missing source; add a line \"# source: <source>\"\n"
            "1:1: error: missing status; add a line \"# status: <status>\"\n"
            "1:1: error: missing processing; add a line \"# processing: <processing>\"\n"
            "1:1: error: missing outside; add a line \"# outside: <outside>\"\n");
  EXPECT_EQ(complaints(kHead + "# outside: wrap\nl,a\n1,2\n", TableOrigin::shipped),
            "6:1: error: unknown range rule (got wrap, allowed clamp, zero, error)\n");
}

TEST(Table, UserTablesNeedTheirUnitAlone) {
  EXPECT_EQ(complaints("l,a\n1,2\n", TableOrigin::user),
            "1:1: error: missing unit; add a line \"# unit: <unit>\"\n");
  Diagnostics diagnostics;
  const std::string text = "# unit: W\nl,a\n1,2";
  const auto table = table_of(text, TableOrigin::user, diagnostics);
  ASSERT_TRUE(table.has_value()) << diagnostics.text();
  EXPECT_EQ(table->outside, Outside::error);
  EXPECT_EQ(table->provenance.title, "t");
  EXPECT_TRUE(table->provenance.source.ends_with("t.csv (SHA-256 " + sha256(text) + ")"))
      << table->provenance.source;
  EXPECT_EQ(table->rows.size(), 1U);
}

TEST(Table, MalformedLinesAreAllReported) {
  EXPECT_EQ(
      complaints("# unit: W\n# unit: V\nl,a,a,\n1,2\n1,2,3,4\n\"1,2,3,4\n1,\"2\"x,3,4\n", TableOrigin::user),
      "2:1: error: repeated line \"# unit:\"\n"
      "3:5: error: duplicate column \"a\"\n"
      "3:7: error: empty column name\n"
      "4:1: error: wrong number of cells (got 2, allowed 4)\n"
      "6:1: error: quoted cell without its closing quote\n"
      "7:1: error: quoted cell without its closing quote\n");
  EXPECT_EQ(complaints("# unit: W\nl,a\n", TableOrigin::user),
            "3:1: error: expected a line of column names and at least one row\n");
  EXPECT_EQ(complaints("", TableOrigin::user),
            "1:1: error: expected a line of column names and at least one row\n"
            "1:1: error: missing unit; add a line \"# unit: <unit>\"\n");
}

TEST(Table, LinesThatWouldGovernItAreReadOrRefused) {
  EXPECT_EQ(complaints("# unit: W\n# interpolation = sprague\nl,a\n1,2\n", TableOrigin::user),
            "2:1: error: \"# interpolation =\" is not read; write \"# interpolation: <interpolation>\"\n");
  EXPECT_EQ(complaints("# unit: W\nl,a\n# outside: zero\n1,2\n# outside=zero: no\n", TableOrigin::user),
            "3:1: error: \"# outside:\" is not read below the column names; move it above them\n"
            "5:1: error: \"# outside =\" is not read; write \"# outside: <outside>\"\n");
  Diagnostics diagnostics;
  EXPECT_TRUE(table_of("# unit: W\n# note: unit = W\n# T = 25 C\nl,a\n# note: hot\n1,2\n", TableOrigin::user,
                       diagnostics))
      << diagnostics.text();
}

TEST(Table, WhatSpreadsheetsWriteIsNamed) {
  const std::string mark = "\xEF\xBB\xBF";
  EXPECT_EQ(complaints(mark + "# unit: W\nl,a\n1,2\n", TableOrigin::user),
            "1:1: error: begins with a byte order mark; save it as UTF-8 without one\n");
  EXPECT_EQ(complaints("# unit: W\nl;a\n1;0,5\n2;0,25\n", TableOrigin::user),
            "2:2: error: cells are separated by semicolons (got ';', allowed ',')\n");
  EXPECT_EQ(complaints("# unit: W\nl,a\n1,2\n2;3\n3;4\n", TableOrigin::user),
            "4:2: error: cells are separated by semicolons (got ';', allowed ',')\n");
  EXPECT_EQ(complaints("# unit: W\nl\ta\n1\t0,5\n2\t0,25\n", TableOrigin::user),
            "2:2: error: cells are separated by tabs (got a tab, allowed ',')\n");
  EXPECT_EQ(complaints("# unit: W\nl,a\n1,2\n\t20 \t3\n3\t4\n", TableOrigin::user),
            "4:5: error: cells are separated by tabs (got a tab, allowed ',')\n");
  EXPECT_EQ(complaints("# unit: W\n\"l\"\t\"a\"\n\"1\"\t\"2\"\n", TableOrigin::user),
            "2:4: error: cells are separated by tabs (got a tab, allowed ',')\n");
  EXPECT_EQ(complaints("# unit: W\nl,a\n\"1;\";2\n", TableOrigin::user),
            "3:5: error: cells are separated by semicolons (got ';', allowed ',')\n");
  EXPECT_EQ(complaints("# unit: W\nl,a\n1,2\n\"1;2\n", TableOrigin::user),
            "4:1: error: quoted cell without its closing quote\n");
  for (const char* row : {"1,\"a;b", "1,\t\"2", "\"1\" x,2;3"})
    EXPECT_EQ(complaints(std::string("# unit: W\nl,a\n1,2\n") + row + "\n", TableOrigin::user),
              "4:1: error: quoted cell without its closing quote\n")
        << row;
  Diagnostics diagnostics;
  EXPECT_TRUE(table_of("# unit: W\n\"l;\t\"\n1\n", TableOrigin::user, diagnostics)) << diagnostics.text();
  EXPECT_TRUE(table_of("# unit: W; per nm\nl,\"a;b\"\n1,x;y\n", TableOrigin::user, diagnostics))
      << diagnostics.text();
  EXPECT_TRUE(table_of("# unit: W\nl\t\n\t1\t\n", TableOrigin::user, diagnostics))
      << "one column with tabs about it: " << diagnostics.text();
}

TEST(Table, BadNumbersPointAtTheCell) {
  Diagnostics diagnostics;
  const auto table = table_of("# unit: W\nl,\"a\"\n1, x\n2,\n3,4\n4,nan\n", TableOrigin::user, diagnostics);
  ASSERT_TRUE(table.has_value());
  EXPECT_EQ(table->numbers(1, diagnostics), std::nullopt);
  ASSERT_EQ(diagnostics.all().size(), 3U);
  const std::string text = diagnostics.text();
  EXPECT_NE(
      text.find(
          "t.csv:3:4: error: expected a number in column \"a\" (got \"x\", allowed finite decimal numbers)\n"
          "1, x\n   ^\n"),
      std::string::npos)
      << text;
  EXPECT_NE(text.find("t.csv:4:3:"), std::string::npos) << text;
  EXPECT_NE(text.find("t.csv:6:3:"), std::string::npos) << text;
}

/// A data directory of this test program's own, chosen before anything asks for it.
class FindTable : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const std::filesystem::path folder = data_directory() / "light";
    std::filesystem::create_directories(folder);
    put(folder / "cie.csv",
        "# aliases: tungsten=A, noon = D65\n# unit: 1\nwavelength_nm,A,D65,twice\n400,1,2,3\n");
    put(folder / "led.csv", "# aliases: diode=led, dio=white\nwavelength_nm,white\n400,1\n");
    put(folder / "other.csv", "wavelength_nm,twice,led\n400,1,2\n");
    put(folder / "notes.txt", "wavelength_nm,hidden\n");
  }

  /// "file:column" found for a name, or the complaint.
  static std::string found(const std::string& name) {
    Diagnostics diagnostics;
    const auto column = find_table("light", name, {source("x"), 0, "/lights/0"}, diagnostics);
    EXPECT_EQ(column.has_value(), !diagnostics.has_errors());
    if (column) return column->path.filename().string() + ":" + column->column;
    return diagnostics.all().front().message;
  }
};

TEST_F(FindTable, ByStemColumnAliasAndBoth) {
  EXPECT_EQ(found("A"), "cie.csv:A");
  EXPECT_EQ(found("cie"), "cie.csv:");
  EXPECT_EQ(found("cie:twice"), "cie.csv:twice");
  EXPECT_EQ(found("cie:D65"), "cie.csv:D65");
  EXPECT_EQ(found("led"), "led.csv:white");
  EXPECT_EQ(found("white"), "led.csv:white");
  EXPECT_EQ(found("tungsten"), "cie.csv:A");
  EXPECT_EQ(found("noon"), "cie.csv:D65");
  EXPECT_EQ(found("diode"), "led.csv:white");
  EXPECT_EQ(found("dio"), "led.csv:white");
}

TEST_F(FindTable, WhatIsNotThereIsReportedWithTheNearestName) {
  EXPECT_EQ(found("D66"), "unknown light \"D66\"; did you mean \"D65\"?");
  EXPECT_EQ(found("wavelength_nm").substr(0, 30), "unknown light \"wavelength_nm\";")
      << "the abscissa is no value";
  EXPECT_EQ(found("hidden").substr(0, 22), "unknown light \"hidden\"");
  EXPECT_EQ(found("twice").substr(0, 21), "unknown light \"twice\"") << "ambiguous";
}

TEST_F(FindTable, ListsItsNames) {
  EXPECT_EQ(table_names("light"),
            (std::vector<std::string>{"A", "D65", "cie", "cie:twice", "dio", "diode", "led", "noon", "other",
                                      "other:twice", "tungsten", "white"}));
  EXPECT_TRUE(table_names("no such folder").empty());
}

TEST_F(FindTable, WavelengthsAreNoValuesWhereverTheyStand) {
  const auto path = test_folder() / "late.csv";
  for (const char* columns : {"a,wavelength_nm", "wavelength_nm,a", "wavelength_nm,a,wavelength_um"}) {
    put(path, std::string("# unit: W\n") + columns + "\n");
    EXPECT_EQ(found(path.string()), "late.csv:a") << columns;
  }
}

TEST_F(FindTable, FindsUserFilesByTheirPaths) {
  const auto folder = test_folder();
  put(folder / "mine.csv", "# unit: W\nl,a,b\n1,2,3\n");
  const auto scene = std::make_shared<SourceText>(SourceText{(folder / "scene.json").string(), ""});
  Diagnostics diagnostics;
  const auto all = find_table("light", (folder / "mine.csv").string(), {scene, 0, ""}, diagnostics);
  ASSERT_TRUE(all.has_value()) << diagnostics.text();
  EXPECT_EQ(all->path, folder / "mine.csv");
  EXPECT_EQ(all->column, "");
  const auto b = find_table("light", (folder / "mine.csv:b").string(), {}, diagnostics);
  ASSERT_TRUE(b.has_value()) << diagnostics.text();
  EXPECT_EQ(b->column, "b");
  put(folder / "LOUD.CSV", "# unit: W\nl,a,b\n1,2,3\n");
  const auto loud = find_table("light", (folder / "LOUD.CSV:b").string(), {}, diagnostics);
  ASSERT_TRUE(loud.has_value()) << diagnostics.text();
  EXPECT_EQ(loud->path, folder / "LOUD.CSV");
  EXPECT_EQ(loud->column, "b");
  EXPECT_TRUE(find_table("light", (folder / "LOUD.CSV").string(), {}, diagnostics));
  EXPECT_FALSE(
      find_table("light", (folder / "mine.csv:c").string(), {scene, 0, ""}, diagnostics).has_value());
  EXPECT_FALSE(find_table("light", (folder / "none.csv").string(), {scene, 0, ""}, diagnostics).has_value());
  // What `read_table` will refuse in its own words is found, whatever its columns look like.
  put(folder / "marked.csv", "\xEF\xBB\xBF# unit: W\nl,a,b\n1,2,3\n");
  put(folder / "semicolons.csv", "# unit: W\nl;a;b\n1;2;3\n");
  put(folder / "tabs.csv", "# unit: W\nl\ta\tb\n1\t2\t3\n");
  put(folder / "quoted.csv", "# unit: W\n\"l\"\t\"a\"\t\"b\"\n1\t2\t3\n");
  for (const char* name : {"marked.csv:b", "semicolons.csv:b", "tabs.csv:b", "quoted.csv:b"})
    EXPECT_EQ(find_table("light", (folder / name).string(), {}, diagnostics).value().column, "b") << name;
  ASSERT_EQ(diagnostics.all().size(), 2U);
  EXPECT_EQ(diagnostics.all()[0].message, "unknown column \"c\"; known: a, b");
  EXPECT_EQ(diagnostics.all()[1].message, "no such file \"" + (folder / "none.csv").string() + "\"");
  EXPECT_EQ(diagnostics.all()[1].code, ErrorCode::input);
}

}  // namespace
}  // namespace abbe
