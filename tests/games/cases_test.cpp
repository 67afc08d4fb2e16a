// The cases of tests/data/games: every rule-book sentence that a record can show, as a shot.
#include <gtest/gtest.h>

#include <array>
#include <cctype>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "carom/games/rules.h"
#include "made_record.h"

namespace carom::test {
namespace {

using games::Game;
using games::State;
using games::Verdict;

using Words = std::vector<std::string>;

Words split(const std::string& text, char at) {
    Words words;
    std::stringstream stream(text);
    for (std::string word; std::getline(stream, word, at);) {
        const std::size_t from = word.find_first_not_of(' ');
        if (from != std::string::npos)
            words.push_back(word.substr(from, word.find_last_not_of(' ') + 1 - from));
    }
    return words;
}

std::string joined(const Words& words) {
    std::string text;
    for (std::string word : words) {
        for (char& c : word) c = c == ' ' ? '_' : c;
        text += (text.empty() ? "" : "+") + word;
    }
    return text.empty() ? "none" : text;
}

template <class E>
E value(const std::string& text) {
    const auto names = names_of(E{});
    for (std::size_t i = 0; i < names.size(); ++i)
        if (joined({names[i]}) == text) return static_cast<E>(i);
    throw std::invalid_argument("no such name: " + text);
}

/// "1-3,8"
Words balls_in(const std::string& text) {
    Words ids;
    for (const std::string& part : split(text, ',')) {
        const std::size_t dash = part.find('-');
        if (dash == std::string::npos)
            ids.push_back(part);
        else
            for (const std::string& id : numbered(std::stoi(part), std::stoi(part.substr(dash + 1))))
                ids.push_back(id);
    }
    return ids;
}

std::pair<double, double> two(const std::string& text, char at) {
    return {std::stod(text), std::stod(text.substr(text.find(at) + 1))};
}

/// A line of a file.
struct Case {
    Game game{};
    State state;
    Words balls;
    std::vector<std::pair<std::string, std::pair<double, double>>> places;
    games::Call call;

    Case(Game of, const std::string& text) : game(of), state(games::new_game(of)) {
        const bool carom =
            of == &games::kThreeCushion || of == &games::kStraightRail || of == &games::kOneCushion;
        if (carom) balls = {"white", "yellow", "red"};
        if (of == &games::kFourBall) balls = {"white", "yellow", "red1", "red2"};
        if (of == &games::kSnooker)
            balls = {"cue", "1", "2", "yellow", "green", "brown", "blue", "pink", "black"};
        if (balls.empty())
            set("balls=1-" + std::to_string(of == &games::kNineBall ? 9 : of == &games::kTenBall ? 10 : 15));
        for (const std::string& word : split(text, ' ')) set(word);
    }

    void set(const std::string& word) {
        const std::size_t equals = word.find('='), at = word.find('@');
        const std::string key = word.substr(0, equals),
                          to = equals == std::string::npos ? "" : word.substr(equals + 1);
        if (word[0] == '+') return games::set_rule(state, word.substr(1));
        if (at != std::string::npos && equals == std::string::npos)
            return places.emplace_back(word.substr(0, at), two(word.substr(at + 1), ',')), void();
        const auto both = [&] { return std::array{int(two(to, ':').first), int(two(to, ':').second)}; };
        if (key == "play") state.opening = false, state.in_hand = games::InHand::kNo;
        if (key == "turn") state.turn = std::stoi(to);
        if (key == "points") state.points = both();
        if (key == "fouls") state.fouls = both();
        if (key == "target") state.target = std::stoi(to);
        if (key == "push") state.may_push_out = to == "1";
        if (key == "free") state.free_ball = to == "1";
        if (key == "on") state.on = value<games::BallOn>(to);
        if (key == "in_hand") state.in_hand = value<games::InHand>(to);
        if (key == "group") {
            const auto own = value<games::Group>(to);
            state.group[0] = own;
            state.group[1] = own == games::Group::kSolids ? games::Group::kStripes : games::Group::kSolids;
        }
        if (key == "balls") {
            balls = {"cue"};
            for (const std::string& id : balls_in(to)) balls.push_back(id);
        }
    }
    void announce(const std::string& text) {
        for (const std::string& word : split(text, ' ')) {
            if (word == "safety") call.safety = true;
            if (word == "push") call.push_out = true;
            if (word == "-" || word == "safety" || word == "push") continue;
            call.ball = word.substr(0, word.find(':'));
            if (word.find(':') != std::string::npos) call.pocket = word.substr(word.find(':') + 1);
        }
    }
    Record played(const std::string& text) const {
        const bool carom = balls[0] == "white";
        Told told(carom                          ? "carom"
                  : game == &games::kSnooker     ? "snooker"
                  : game == &games::kFreePyramid ? "pyramid"
                                                 : "nine_foot");
        for (const std::string& id : balls) {
            bool placed = false;
            for (const auto& [ball, place] : places)
                if (ball == id) told.ball(id, place.first, place.second), placed = true;
            if (!placed && id == "cue") told.ball(id, 0.6, 0.3);
            if (!placed && id != "cue") told.balls({id});
        }
        Words words = split(text, ' ');
        std::string struck = carom ? games::cue_ball(state) : "cue";
        if (words[0].rfind("strike=", 0) == 0) struck = words[0].substr(7), words.erase(words.begin());
        told.strike(struck);
        for (const std::string& word : words) {
            const std::size_t sign = word.find_first_of(">|:!@.");
            const std::string ball = word.substr(0, sign), to = word.substr(sign + 1);
            switch (word[sign]) {
                case '>':
                    if (const std::size_t both = to.find('&'); both != std::string::npos)
                        told.hit_both(ball, to.substr(0, both), to.substr(both + 1));
                    else
                        told.hit(ball, to);
                    break;
                case '|':
                    told.cushion(ball, to.empty() ? 2 : std::stoi(to));
                    break;
                case ':':
                    told.pocket(ball, to);
                    break;
                case '!':
                    told.out(ball);
                    break;
                case '@':
                    told.rests(ball, two(to, ',').first, two(to, ',').second);
                    break;
                default:
                    break;
            }
        }
        return told.record();
    }
};

std::string place_of(const std::string& ball, const games::Option& option, const std::string& expected) {
    for (const games::Respot& back : option.respots)
        if (back.ball == ball) {
            const Vec2 wanted(two(expected, ',').first, two(expected, ',').second);
            return (back.place - wanted).norm() < 1e-6 ? expected : "elsewhere";
        }
    return "nowhere";
}

/// A number of a verdict, by name.
std::string told_of(const std::string& key, const Verdict& v, const std::string& expected) {
    const games::Option& option = v.options.front();
    const State& s = option.state;
    const auto pair = [](const std::array<int, 2>& p) {
        return std::to_string(p[0]) + ":" + std::to_string(p[1]);
    };
    Words fouls, options, back;
    for (const games::CalledFoul& called : v.fouls) fouls.emplace_back(name(called.foul));
    for (const games::Option& o : v.options) options.emplace_back(name(o.decision));
    for (const games::Respot& r : option.respots) back.push_back(r.ball);
    if (key == "fair" || key == "foul") return joined(fouls);
    if (key == "turn") return std::to_string(s.turn);
    if (key == "turn2") return std::to_string(v.options.at(1).state.turn);
    if (key == "points") return std::to_string(v.points);
    if (key == "penalty") return std::to_string(v.penalty);
    if (key == "score") return pair(s.points);
    if (key == "fouls") return pair(s.fouls);
    if (key == "fouls3") return pair(v.options.at(2).state.fouls);
    if (key == "chooser") return std::to_string(v.chooser);
    if (key == "push") return s.may_push_out ? "1" : "0";
    if (key == "free") return s.free_ball ? "1" : "0";
    if (key == "opening") return s.opening ? "1" : "0";
    if (key == "over") return s.over ? std::to_string(s.winner) : "no";
    if (key == "in_hand") return joined({name(s.in_hand)});
    if (key == "group") return joined({name(s.group[0])});
    if (key == "on") return name(s.on);
    if (key == "options") return joined(options);
    if (key == "respot") return joined(back);
    if (key == "respots") return std::to_string(back.size());
    if (key == "apex") {
        const Vec2 apex = foot_spot(make_table("nine_foot"));
        for (const games::Respot& r : option.respots)
            if (r.place == apex) return "taken";
        return "free";
    }
    if (key.rfind("place", 0) == 0) return place_of(key.substr(5), option, expected);
    return "no such key";
}

std::string told_of(const std::string& key, const State& state, const Words& balls) {
    const games::Legal legal = games::legal(state, balls);
    if (key == "first") return joined(legal.first);
    if (key == "callable") return joined(legal.callable);
    if (key == "cue_balls") return joined(legal.cue_balls);
    if (key == "in_hand") return joined({name(legal.in_hand)});
    if (key == "target") return std::to_string(state.target);
    return "no such key";
}

class Cases : public testing::TestWithParam<std::string> {};

TEST_P(Cases, AreJudgedByTheBook) {
    const Game game = games::game_named(GetParam());
    std::ifstream file(std::string(CAROM_SOURCE_DIR) + "/tests/data/games/" + GetParam() + ".txt");
    int cases = 0;
    for (std::string line; std::getline(file, line);) {
        if (line.empty() || line[0] == '#') continue;
        SCOPED_TRACE(line);
        ++cases;
        // A cushion is a | without spaces around it.
        Words columns;
        std::size_t from = 0;
        for (std::size_t at = 0; (at = line.find(" | ", from)) != std::string::npos; from = at + 3)
            columns.push_back(line.substr(from, at - from));
        columns.push_back(line.substr(from));
        ASSERT_EQ(columns.size(), 5u);
        Case told(game, columns[1]);
        told.announce(columns[3]);
        const bool asks = split(columns[2], ' ') == Words{"-"};
        const Verdict verdict =
            asks ? Verdict() : games::judge(told.state, told.played(columns[2]), told.call);
        for (const std::string& word : split(columns[4], ' ')) {
            const std::size_t equals = word.find('=');
            const std::string key = word.substr(0, equals),
                              expected = equals == std::string::npos ? "none" : word.substr(equals + 1);
            EXPECT_EQ(asks ? told_of(key, told.state, told.balls) : told_of(key, verdict, expected), expected)
                << key;
        }
    }
    EXPECT_GE(cases, 25);
}

std::vector<std::string> all_games() {
    std::vector<std::string> list;
    for (const Game game : games::all_of(Game{})) list.emplace_back(name(game));
    std::erase(list, "sum_to_three");
    return list;
}

INSTANTIATE_TEST_SUITE_P(Of, Cases, testing::ValuesIn(all_games()), [](const auto& of) { return of.param; });

}  // namespace
}  // namespace carom::test
