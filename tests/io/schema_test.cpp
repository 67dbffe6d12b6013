// Tables of fields, on a small thing that has every kind of field.
#include "io/schema/fields.h"

#include <array>
#include <limits>
#include <variant>

#include <gtest/gtest.h>

#include "io/schema/read.h"
#include "io/schema/write.h"
#include "test_files.h"

namespace abbe::test {
namespace {

using schema::at_most_one;
using schema::describe;
using schema::field;
using schema::Fields;
using schema::inlined;
using schema::inlined_by;
using schema::Json;
using schema::Located;
using schema::Named;
using schema::one_of;
using schema::Tag;
using schema::under;

constexpr Range kLength{0, 1e12, true, false};

/// Part of a lamp that others have too.
struct Place {
  std::array<double, 3> at{};
  std::optional<std::array<double, 3>> towards;
};
[[maybe_unused]] Fields fields(Tag<Place>) {
  return describe("place", "Where something is.",
                  {field("at", &Place::at, schema::vector<std::array<double, 3>>({-10, 10}), "Its middle."),
                   field("towards", &Place::towards, schema::vector<std::array<double, 3>>({-10, 10}, true),
                         "Where it looks.")});
}

struct Bulb {
  double radius = 0;
};
[[maybe_unused]] Fields fields(Tag<Bulb>) {
  return describe("bulb", "A ball of light.", {field("radius", &Bulb::radius, kLength, "Its radius.")});
}

/// Stands beside what it is chosen by.
struct Tube {
  double length = 0;
  double width = 0.5;
  Located<bool> cold;
};
[[maybe_unused]] Fields fields(Tag<Tube>) {
  return describe("tube", "",
                  {field("tube_length", &Tube::length, kLength, "How long it is."),
                   schema::defaulted("width", &Tube::width, Range::unit(), "How wide it is."),
                   field("cold", &Tube::cold, "Whether it starts slowly.")});
}

enum class Colour { red, green };
struct Power : schema::Value<double> {};
struct Ratio {
  double share = 0;
};
using Strength = std::variant<double, std::string>;

struct Lamp {
  std::optional<std::string> name;
  std::variant<std::monostate, Bulb, Tube> kind;
  Place place;
  Colour colour = Colour::green;
  int count = 2;
  double limit = std::numeric_limits<double>::infinity();
  std::variant<std::monostate, Power, Ratio> scale;
  std::vector<double> steps;
  std::optional<Strength> strength;
  std::vector<Named<Bulb>> spares;
  std::vector<Bulb> bulbs;
  std::optional<double> watts;
  std::optional<double> volts;
  SourcePosition where;
};
[[maybe_unused]] Fields fields(Tag<Ratio>) {
  return describe("ratio", "", {field("ratio", &Ratio::share, Range::unit(), "A share.")});
}
[[maybe_unused]] Fields fields(Tag<Lamp>) {
  return describe(
      "lamp", "What gives light.",
      {field("name", &Lamp::name, "For messages."),
       one_of(&Lamp::kind, under<Bulb>("bulb", "A ball."), inlined_by<Tube>("tube_length")),
       inlined(&Lamp::place),
       schema::defaulted("colour", &Lamp::colour, schema::enumeration<Colour>("colour", {"red", "green"}),
                         "Its colour."),
       schema::defaulted("count", &Lamp::count, {1, 9}, "How many."),
       schema::defaulted("limit", &Lamp::limit, Range::positive(), "At most."),
       at_most_one(&Lamp::scale, "a lamp has one scale", under<Power>("power", kLength, "In watts."),
                   inlined_by<Ratio>("ratio")),
       schema::defaulted("steps", &Lamp::steps, {0, 5}, "Of the dimmer."),
       field("strength", &Lamp::strength,
             schema::forms<Strength>("strength", "a strength: a number or a name",
                                     schema::form<double>(Json::number, {0, 1}),
                                     schema::form<std::string>(Json::text)),
             "How strong it is."),
       schema::defaulted("spares", &Lamp::spares, schema::by_name<Bulb>("spares by name", 1),
                         "In the cupboard."),
       schema::defaulted("bulbs", &Lamp::bulbs, schema::list<Bulb>("bulbs", 1, true), "Others."),
       field("watts", &Lamp::watts, {0, 100}, "Power."), field("volts", &Lamp::volts, {0, 100}, "Voltage.")},
      {"watts", "volts"});
}

struct Reading {
  std::optional<Lamp> lamp;
  std::string complaints;  // first lines
};
Reading read(const std::string& text) {
  Diagnostics diagnostics;
  const auto json = parse_json(source(text), diagnostics);
  Reading reading;
  if (json) reading.lamp = schema::read<Lamp>(*json, diagnostics);
  for (const Diagnostic& diagnostic : diagnostics.all()) {
    const std::string line = format(diagnostic);
    reading.complaints += line.substr(0, line.find('\n')) + '\n';
  }
  return reading;
}

constexpr char kAll[] =
    R"({"name":"n","tube_length":2,"width":0.25,"cold":true,"at":[1,2,3],"towards":[0,0,1],"colour":"red",)"
    R"("count":7,"limit":8,"ratio":0.1,"steps":[1,2.5],"strength":"full","spares":{"a":{"radius":3}},)"
    R"("bulbs":[{"radius":1},{"radius":0.1}],"volts":12})";

TEST(SchemaTest, ReadsEveryKind) {
  const Reading r = read(kAll);
  ASSERT_TRUE(r.lamp) << r.complaints;
  EXPECT_EQ(r.lamp->name, "n");
  const Tube& tube = std::get<Tube>(r.lamp->kind);
  EXPECT_EQ(tube.length, 2);
  EXPECT_EQ(tube.width, 0.25);
  EXPECT_TRUE(tube.cold.value);
  EXPECT_EQ(tube.cold.where.pointer, "/cold");
  EXPECT_EQ(r.lamp->place.at[2], 3);
  EXPECT_EQ(r.lamp->place.towards.value()[2], 1);
  EXPECT_EQ(r.lamp->colour, Colour::red);
  EXPECT_EQ(r.lamp->count, 7);
  EXPECT_EQ(r.lamp->limit, 8);
  EXPECT_EQ(std::get<Ratio>(r.lamp->scale).share, 0.1);
  EXPECT_EQ(r.lamp->steps, (std::vector<double>{1, 2.5}));
  EXPECT_EQ(std::get<std::string>(r.lamp->strength.value()), "full");
  EXPECT_EQ(r.lamp->spares.at(0).name, "a");
  EXPECT_EQ(r.lamp->spares.at(0).value.radius, 3);
  EXPECT_EQ(r.lamp->spares.at(0).where.pointer, "/spares/a");
  EXPECT_EQ(r.lamp->bulbs.at(1).radius, 0.1);
  EXPECT_EQ(r.lamp->volts, 12);
}

TEST(SchemaTest, WritesWhatItRead) {
  EXPECT_EQ(to_text(schema::write(read(kAll).lamp.value())), kAll);
  // Without what is so by default; a single one without brackets.
  const Reading brief = read(
      R"({"bulb":{"radius":0.1},"at":[0.1,0,0],"count":2,"colour":"green","power":3,"bulbs":[{"radius":1}],"watts":1e-3})");
  EXPECT_EQ(to_text(schema::write(brief.lamp.value())),
            R"({"bulb":{"radius":0.1},"at":[0.1,0,0],"power":3,"bulbs":{"radius":1},"watts":0.001})");
}

TEST(SchemaTest, SaysWhatIsWrong) {
  const std::string rest = R"("at": [0, 0, 0], "watts": 1)";
  const auto complaints = [&](const std::string& members) {
    return read("{" + members + rest + "}").complaints;
  };
  const std::string bulb = R"("bulb": {"radius": 1}, )";
  EXPECT_EQ(complaints(bulb), "");
  EXPECT_EQ(read("3").complaints, "a.json:1:1: error: expected an object (got 3, allowed {...})\n");
  EXPECT_EQ(complaints(""),
            "a.json:1:1: error: expected exactly one key (got none, allowed bulb, tube_length)\n");
  EXPECT_EQ(complaints(R"("blub": {}, )"),
            "a.json:1:2: /blub: error: unknown key \"blub\"; did you mean \"bulb\"?\n");
  EXPECT_EQ(complaints(R"("bulb": {"radius": 0}, )"),
            "a.json:1:21: /bulb/radius: error: expected a number (got 0, allowed (0, 1000000000000])\n");
  EXPECT_EQ(complaints(R"("bulb": {}, )"), "a.json:1:10: /bulb: error: missing key \"radius\"\n");
  EXPECT_EQ(complaints(bulb + R"("width": 1, )"),
            "a.json:1:25: /width: error: width requires tube_length, which is missing\n");
  EXPECT_EQ(complaints(R"("tube_length": 1, "cold": true, "widht": 1, )"),
            "a.json:1:34: /widht: error: unknown key \"widht\"; did you mean \"width\"?\n");
  EXPECT_EQ(complaints(R"("tube_length": 1, )"), "a.json:1:1: error: missing key \"cold\"\n");
  EXPECT_EQ(complaints(bulb + R"("power": 1, "ratio": 1, )"),
            "a.json:1:1: error: a lamp has one scale (got power and ratio)\n");
  EXPECT_EQ(complaints(bulb + R"("colour": "gren", )"),
            "a.json:1:35: /colour: error: unknown colour \"gren\"; did you mean \"green\"?\n");
  EXPECT_EQ(complaints(bulb + R"("count": 1.5, )"),
            "a.json:1:34: /count: error: expected an integer (got 1.5, allowed [1, 9])\n");
  EXPECT_EQ(complaints(bulb + R"("towards": [0, 0, 0], )"),
            "a.json:1:36: /towards: error: a direction must not be zero (got [0, 0, 0])\n");
  EXPECT_EQ(complaints(bulb + R"("strength": [], )"),
            "a.json:1:37: /strength: error: expected a strength: a number or a name (got an array)\n");
  EXPECT_EQ(complaints(bulb + R"("spares": {}, )"),
            "a.json:1:35: /spares: error: expected spares by name (got none)\n");
  EXPECT_EQ(complaints(bulb + R"("bulbs": [], )"),
            "a.json:1:34: /bulbs: error: expected an array of bulbs (got 0 of them, allowed [1, inf))\n");
  EXPECT_EQ(read(R"({"bulb": {"radius": 1}, "at": [0, 0, 0]})").complaints,
            "a.json:1:1: error: missing key \"watts\" or \"volts\"\n");
  EXPECT_EQ(complaints(R"("bulb": {"radius": -1}, "count": 0, "what": 0, )"),
            "a.json:1:21: /bulb/radius: error: expected a number (got -1, allowed (0, 1000000000000])\n"
            "a.json:1:35: /count: error: expected an integer (got 0, allowed [1, 9])\n"
            "a.json:1:38: /what: error: unknown key \"what\"; did you mean \"at\"?\n")
      << "all at once";
}

TEST(SchemaTest, DescribesWhatItReads) {
  const std::string text = to_text(schema::json_schema(schema::fields_of<Lamp>()));
  const auto expect = [&](const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << part << " in " << text;
  };
  expect(R"("bulb":{"$ref":"#/$defs/bulb","description":"A ball."})");
  expect(
      R"("radius":{"type":"number","exclusiveMinimum":0,"maximum":1000000000000,"description":"Its radius."})");
  expect(R"("required":["at"])");
  expect(R"("strength":{"$ref":"#/$defs/strength","description":"How strong it is."})");
  expect(R"("oneOf":[{"required":["bulb"]},{"required":["tube_length"]}],"dependentSchemas":{)");
  expect(R"("cold":{"anyOf":[{"required":["tube_length"]}]})");
  expect(R"("tube_length":{"required":["cold"]})");
  expect(R"("not":{"const":[0,0,0]})");
  expect(R"("colour":{"enum":["red","green"],"description":"Its colour.","default":"green"})");
  expect(
      R"("limit":{"type":"number","exclusiveMinimum":0,"maximum":3.4028234663852886e+38,"description":"At most."})");
  expect(R"({"anyOf":[{"required":["watts"]},{"required":["volts"]}]})");
  expect(R"({"not":{"anyOf":[{"required":["power"]},{"required":["ratio"]}]}})");
}

// A table that is wrong about a member is our bug.
TEST(SchemaTest, RefusesATableOfOtherTypes) {
  EXPECT_THROW((void)field("count", &Lamp::count, schema::within<double>(kLength), ""), Error);
}

// A thing that may be a row of the values of its first keys.
struct Layer {
  double thickness = 1;
  std::optional<std::string> glass;
  bool last = false;
};
[[maybe_unused]] Fields fields(Tag<Layer>) {
  return describe("layer", "What light passes.",
                  {schema::defaulted("thickness", &Layer::thickness, {0, 9}, "How thick it is."),
                   field("glass", &Layer::glass, "What it is of."),
                   schema::defaulted("last", &Layer::last, "Whether others follow.")})
      .or_array(1, 2);
}

TEST(Schema, RowsStandForTheFirstKeys) {
  const auto layer = [](const std::string& text, std::string* complaint = nullptr) {
    Diagnostics diagnostics;
    const auto json = parse_json(source(text), diagnostics);
    const auto read = schema::read<Layer>(*json, diagnostics);
    if (complaint != nullptr) *complaint = diagnostics.text();
    return read;
  };
  EXPECT_EQ(layer(R"([2, "BK7"])")->thickness, 2);
  EXPECT_EQ(layer(R"([2, "BK7"])")->glass, "BK7");
  EXPECT_EQ(layer(R"([null, "BK7"])")->thickness, 1);
  EXPECT_FALSE(layer("[3]")->glass);
  EXPECT_TRUE(layer(R"({"thickness": 3, "last": true})")->last);
  std::string complaint;
  EXPECT_FALSE(layer(R"([2, "BK7", true])", &complaint));
  EXPECT_NE(complaint.find("has the values thickness, glass (got 3 values, allowed 1 to 2)"),
            std::string::npos)
      << complaint;
  EXPECT_FALSE(layer("[2, 3]", &complaint));
  EXPECT_NE(complaint.find("1:5: /1: error: expected a string"), std::string::npos) << complaint;
}

}  // namespace
}  // namespace abbe::test
