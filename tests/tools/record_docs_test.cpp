// docs/reference/record_format.md and record.schema.json against written records: the same keys; the records
// of all scenes are valid, and nothing else is.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "carom/engine/simulate.h"
#include "support/json_schema.h"
#include "support/pages.h"
#include "support/process.h"

namespace carom {
namespace {

using test::Json;
using test::SchemaCheck;
using test::TemporaryFolder;

Json schema() {
    return Json::parse(test::read_source("docs/reference/record.schema.json"));
}

std::string written(const Record& record) {
    const TemporaryFolder folder;
    write_record(record, folder.file("r.json"));
    return test::read_file(folder.file("r.json"));
}

Record record_of(const Scene& scene, bool profile) {
    SimulateOptions options;
    options.profile = profile;
    return simulate(make_plan(scene, kernel::Isa::kScalar), options);
}

std::vector<Scene> scenes() {
    std::vector<Scene> all;
    for (const auto& entry : std::filesystem::directory_iterator(CAROM_SOURCE_DIR "/scenes"))
        if (entry.path().extension() == ".toml") all.push_back(read_scene(entry.path().string()));
    EXPECT_GE(all.size(), 10u);
    // Not in the folder's scenes: friction that falls with the slip, a ball with its own size, an eye.
    all.push_back(parse_scene(
        "[balls]\nmu_b_fit = [0.009951, 0.108, 1.088]\n[render]\neye = [1, 1, 1]\ntarget = [0, 1, 0]\n"
        "[stop]\nevents = 3\n[[ball]]\nid = \"a\"\nposition = [0.6, 1]\nvelocity = [0, 1]\nmass = 0.2\n"
        "[[ball]]\nid = \"b\"\nposition = [0.6, 1.3]\n[physics]\nball_ball = \"inelastic\"\n",
        "fit.toml"));
    // A round wall, and pucks.
    all.push_back(
        parse_scene("[balls]\nshape = \"disc\"\nrolls = false\nmu_b = 0\nf_c = 0\n[[table.arc]]\ncenter = "
                    "[0, 0]\nradius = 1\n"
                    "[[ball]]\nposition = [0, 0]\nvelocity = [1, 0]\n",
                    "pucks.toml"));
    return all;
}

TEST(RecordSchema, DescribesTheRecordsOfAllScenesWhichReadBackWhole) {
    const Json rules = schema();
    const SchemaCheck check(rules);
    for (const Scene& scene : scenes()) {
        for (const bool profile : {false, true}) {
            const Record record = record_of(scene, profile);
            const std::string text = written(record);
            EXPECT_EQ(check.fault(Json::parse(text)), "") << scene.file;
            std::vector<std::string> notes;
            EXPECT_TRUE(parse_record(text, "r.json", &notes) == record) << scene.file;
            EXPECT_EQ(notes, std::vector<std::string>{});
        }
    }
}

// One path per kind of object or value: "/tracks/3/segments/7/r" represents all of its kind.
void each_kind(const Json& value, const std::string& kind, const std::string& at,
               std::map<std::string, std::string>& found) {
    found.emplace(kind, at);
    if (value.is_object())
        for (const auto& [key, part] : value.items())
            each_kind(part, kind + "/" + key, at + "/" + key, found);
    if (value.is_array())
        for (std::size_t i = 0; i < value.size(); ++i)
            each_kind(value[i], kind + "/#", at + "/" + std::to_string(i), found);
}

// A record with every existing key.
Json profiled_break() {
    Scene scene = read_scene(CAROM_SOURCE_DIR "/scenes/eight_ball_break.toml");
    use_cue(*scene.cue, "lossless");
    scene.render.eye = Vec3(1.0, 1.0, 1.0);
    scene.render.target = Vec3(0.0, 1.0, 0.0);
    scene.render.cloth = "#1d6a54";
    scene.render.hides_cue = true;
    Record record = record_of(scene, true);
    record.tracks.front().own = BallSize{0.03, 0.2};
    record.table.bed = Rectangle(0.0, 0.0, 1.27, 2.54);
    record.table.measures = {.cushion_height = 0.036,
                             .rail_width = 0.05,
                             .corner_pockets = {.mouth = 0.11},
                             .side_pockets = {.mouth = 0.13},
                             .size = Vec2(1.27, 2.54)};
    Jaw& arc = record.table.jaws.front();
    arc.side = "outside";
    arc.from_deg = 0.0;
    arc.to_deg = 360.0;
    record.balls.disc = record.balls.slides = true;
    record.events.front().slow = true;
    // Whether a ball hits the end of a cushion depends on the break.
    const auto met = std::find_if(record.events.begin(), record.events.end(),
                                  [](const Event& e) { return e.type == EventType::kBallCushion; });
    met->detail = 0;
    return Json::parse(written(record));
}

TEST(RecordSchema, RefusesUnknownKeysMissingKeysAndOtherTypes) {
    const Json rules = schema(), good = profiled_break();
    const SchemaCheck check(rules);
    ASSERT_EQ(check.fault(good), "");
    std::map<std::string, std::string> kinds;
    each_kind(good, "", "", kinds);
    EXPECT_GE(kinds.size(), 90u);
    // Keys that a valid record may lack.
    const std::set<std::string> free = {"/events/#/balls",
                                        "/events/#/nose",
                                        "/events/#/hits",
                                        "/events/#/slow",
                                        "/table/bed",
                                        "/table/jaws/#/side",
                                        "/table/jaws/#/from_deg",
                                        "/table/jaws/#/to_deg",
                                        "/balls/shape",
                                        "/balls/rolls",
                                        "/table/size",
                                        "/table/cushion_height",
                                        "/table/rail_width",
                                        "/table/corner_pockets",
                                        "/table/corner_pockets/mouth",
                                        "/table/side_pockets",
                                        "/table/side_pockets/mouth",
                                        "/render/cloth",
                                        "/render/cue"};
    for (const auto& [kind, at] : kinds) {
        const Json::json_pointer place(at);
        Json bad = good;
        if (bad[place].is_object()) {
            bad[place]["colour"] = 1;
            EXPECT_NE(check.fault(bad), "") << at << "/colour";
            bad = good;
        }
        bad[place] = good[place].is_boolean() ? Json(0) : Json(true);
        EXPECT_NE(check.fault(bad), "") << at << " = " << bad[place];
        if (at.empty() || kind.back() == '#' || free.count(kind) != 0) continue;
        bad = good;
        bad[place.parent_pointer()].erase(place.back());
        EXPECT_NE(check.fault(bad), "") << at << " is missing";
    }
}

// The objects of a record, and their places in the schema.
const std::pair<const char*, const char*> kObjects[] = {{"The record", ""},
                                                        {"render", "/properties/render"},
                                                        {"table", "/properties/table"},
                                                        {"table.cushions", "/definitions/cushion"},
                                                        {"table.jaws", "/definitions/jaw"},
                                                        {"table.pockets", "/definitions/pocket"},
                                                        {"balls", "/properties/balls"},
                                                        {"tracks", "/definitions/track"},
                                                        {"tracks.segments", "/definitions/segment"},
                                                        {"events", "/definitions/event"}};

// The page leaves the keys to the schema, and explains the choices of values.
TEST(RecordDocs, ThePageExplainsTheNamesOfTheSchema) {
    const Json rules = schema();
    const std::string page = test::read_source("docs/reference/record_format.md");
    for (const auto& [heading, place] : kObjects)
        for (const auto& [key, rule] : rules.at(Json::json_pointer(place)).at("properties").items())
            for (const Json& choice : rule.value("enum", Json::array()))
                EXPECT_NE(page.find("`" + choice.get<std::string>() + "`"), std::string::npos)
                    << heading << "." << key << ": " << choice;
}

TEST(RecordSchema, EveryKeyIsWritten) {
    std::map<std::string, std::string> kinds;
    each_kind(profiled_break(), "", "", kinds);
    const Json rules = schema();
    const std::map<std::string, std::string> prefix = {{"The record", ""},
                                                       {"render", "/render"},
                                                       {"table", "/table"},
                                                       {"table.cushions", "/table/cushions/#"},
                                                       {"table.jaws", "/table/jaws/#"},
                                                       {"table.pockets", "/table/pockets/#"},
                                                       {"balls", "/balls"},
                                                       {"tracks", "/tracks/#"},
                                                       {"tracks.segments", "/tracks/#/segments/#"},
                                                       {"events", "/events/#"}};
    for (const auto& [heading, place] : kObjects) {
        const Json object = rules.at(Json::json_pointer(place));
        for (const auto& [key, rule] : object.at("properties").items())
            EXPECT_EQ(kinds.count(prefix.at(heading) + "/" + key), 1u) << heading << "." << key;
    }
}

TEST(RecordSchema, NamesAllStatesEventsAndReasons) {
    const Json rules = schema();
    const Json states = names_of(MotionState()), reasons = names_of(StopReason());
    Json events;
    for (int i = 0; i < kEventTypes; ++i) events.push_back(name(static_cast<EventType>(i)));
    EXPECT_EQ(rules.at("/definitions/segment/properties/state/enum"_json_pointer), states);
    EXPECT_EQ(rules.at("/definitions/event/properties/type/enum"_json_pointer), events);
    EXPECT_EQ(rules.at("/properties/stopped/enum"_json_pointer), reasons);
}

TEST(RecordDocs, TheExampleIsARecord) {
    const std::string page = test::read_source("docs/reference/record_format.md");
    const std::size_t begin = page.find("```json\n") + 8, end = page.find("```", begin);
    const std::string example = page.substr(begin, end - begin);
    EXPECT_EQ(SchemaCheck(schema()).fault(Json::parse(example)), "");
    EXPECT_EQ(parse_record(example, "page").tracks.size(), 2u);
}

}  // namespace
}  // namespace carom
