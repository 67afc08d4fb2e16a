#include "trials.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/draws.h"
#include "carom/engine/batch.h"
#include "carom/engine/math.h"
#include "carom/engine/printable.h"
#include "carom/engine/scene_number.h"
#include "carom/engine/strike.h"
#include "carom/kernel/splitmix64.h"
#include "lines.h"
#include "unknown.h"

namespace carom::games::detail {

Trials::Trials(const Scene& scene, const Measure& want, kernel::Isa isa, const SolveOptions& options)
    : scene_(scene), want_(want), isa_(isa), options_(options) {
    if (!scene.cue) throw std::invalid_argument("the scene has no [cue]; add one, so that a ball is struck");
    struck_ = static_cast<std::size_t>(std::max(0, index_of(scene.ball, scene.cue->ball)));
    if (options.choices.empty()) throw std::invalid_argument("there is no input to search; give a range");
    for (const Choice& choice : options.choices) {
        if (!(choice.low <= choice.high) || !std::isfinite(choice.high - choice.low))
            throw std::invalid_argument(choice.key + ": expected a range from a to b with a <= b");
        if (choice.key.rfind("hit.", 0) == 0)
            hit_ = ball_of(choice.key.substr(4));
        else if (choice.key != kBallSpeed)
            check_varies(scene, choice.key);
    }
    // Every shot sets these, chosen or not.
    keys_ = {"cue.aim_deg", "cue.speed", "cue.offset.side", "cue.offset.height", "cue.elevation_deg"};
    for (const Choice& choice : options.choices)
        if (choice.key.rfind("hit.", 0) != 0 && choice.key != kBallSpeed &&
            std::find(keys_.begin(), keys_.end(), choice.key) == keys_.end())
            keys_.push_back(choice.key);
    chosen_ = keys_.size();
    if (options.racks || options.unknown != kExactTable) add_table_keys();
}

/// The keys that differ from table to table.
void Trials::add_table_keys() {
    resized_.assign(scene_.ball.size(), false);
    if (options_.racks) {
        const Scene first = options_.racks(0);
        for (std::size_t i = 0; i < scene_.ball.size(); ++i)
            resized_[i] = scene_.ball[i].own != first.ball.at(i).own;
    }
    for (const std::string& key : table_keys(scene_, resized_)) {
        columns_.push_back(
            static_cast<std::size_t>(std::find(keys_.begin(), keys_.end(), key) - keys_.begin()));
        if (columns_.back() == keys_.size()) keys_.push_back(key);
    }
    usual_ = table_values(scene_, resized_);
}

/// The table of a trial, common to all candidates.
const std::vector<double>& Trials::table(std::size_t trial) {
    std::vector<std::vector<double>>& known = tables_[(exact ? 2 : 0) + (fresh ? 1 : 0)];
    while (known.size() <= trial) {
        const std::uint64_t index = 2 * known.size() + (fresh ? 1 : 0);
        Scene table = options_.racks ? options_.racks(index) : scene_;
        if (!exact && options_.unknown != kExactTable)
            table = drawn_table(table, options_.unknown, options_.seed, index);
        known.push_back(table_values(table, resized_));
    }
    return known[trial];
}

int Trials::ball_of(const std::string& id) const {
    const int ball = index_of(scene_.ball, id);
    if (ball >= 0 && static_cast<std::size_t>(ball) == struck_)
        throw std::invalid_argument("hit." + id + ": the cue strikes this ball; name the ball to hit");
    if (ball >= 0) return ball;
    throw std::invalid_argument("hit." + id + ": the scene has no ball " + in_quotes(id));
}

/// The errors of shot number `index`, common to all candidates.
Trials::Draw Trials::draw(std::uint64_t index) const {
    SplitMix64 random(options_.seed * 0x9e3779b97f4a7c15u + 2 * index + (fresh ? 1 : 0));
    const Hand& hand = options_.hand;
    Draw d{};
    d.aim = hand.aim_deg * standard_normal(random);
    d.speed = hand.speed * standard_normal(random);
    d.side = hand.tip * standard_normal(random);
    d.height = hand.tip * standard_normal(random);
    d.elevation = hand.elevation_deg * standard_normal(random);
    return d;
}

/// The cue speed that gives the struck ball this speed, with the other values of the row.
double Trials::speed_of(std::vector<double> row, double ball_speed) const {
    Scene scene = scene_;
    for (std::size_t k = 0; k < chosen_; ++k) SceneNumber(scene_, keys_[k]).put(scene, row[k]);
    return ball_speed / ball_speed_gain(*scene.cue, scene.size_of(scene.ball[struck_]));
}

/// The shot without errors: a value for each of the chosen keys.
std::vector<double> Trials::meant(const std::vector<double>& values) const {
    const Cue& cue = *scene_.cue;
    std::vector<double> row(chosen_);
    const std::array<double, 5> base = {cue.aim_deg, cue.speed, cue.side, cue.height, cue.elevation_deg};
    std::copy(base.begin(), base.end(), row.begin());
    Vec2 place = planar(scene_.ball[struck_].position);
    double hit = std::numeric_limits<double>::quiet_NaN(), ball_speed = hit;
    for (std::size_t k = 0; k < values.size(); ++k) {
        const std::string& key = options_.choices[k].key;
        if (key.rfind("hit.", 0) == 0) {
            hit = values[k];
            continue;
        }
        if (key == kBallSpeed) {
            ball_speed = values[k];
            continue;
        }
        row[static_cast<std::size_t>(std::find(keys_.begin(), keys_.end(), key) - keys_.begin())] = values[k];
        if (key == "ball." + cue.ball + ".position.x") place.x() = values[k];
        if (key == "ball." + cue.ball + ".position.y") place.y() = values[k];
    }
    if (!std::isnan(ball_speed)) row[1] = speed_of(row, ball_speed);
    if (std::isnan(hit)) return row;
    const auto radius = [this](std::size_t ball) {
        return scene_.ball[ball].own.value_or(scene_.balls.size()).R;
    };
    const auto target = static_cast<std::size_t>(hit_);
    const Vec2 way = planar(scene_.ball[target].position) - place;
    row[0] = hit_aim_deg(way, radius(struck_) + radius(target), hit);
    return row;
}

Scene Trials::meant_scene(const std::vector<double>& values) const {
    Scene scene = scene_;
    const std::vector<double> row = meant(values);
    for (std::size_t k = 0; k < chosen_; ++k) SceneNumber(scene_, keys_[k]).put(scene, row[k]);
    return scene;
}

void Trials::play(std::vector<Candidate>& candidates, std::size_t shots,
                  const std::function<void(std::size_t, const Record&)>& look) {
    // Limits the rows of a batch, and so the memory.
    constexpr std::size_t kRows = 1 << 17;
    for (std::size_t begin = 0; begin < candidates.size();) {
        std::size_t rows = 0, end = begin;
        while (end < candidates.size() && (rows == 0 || rows + shots <= kRows))
            rows += shots - std::min(shots, candidates[end++].shots);
        play_rows(std::span(candidates).subspan(begin, end - begin), shots, rows, look);
        begin = end;
    }
}

void Trials::play_rows(std::span<Candidate> candidates, std::size_t shots, std::size_t rows,
                       const std::function<void(std::size_t, const Record&)>& look) {
    if (rows == 0) return;
    std::vector<std::vector<double>> columns(keys_.size());
    for (auto& column : columns) column.reserve(rows);
    std::vector<std::size_t> owner;
    owner.reserve(rows);
    for (std::size_t c = 0; c < candidates.size(); ++c) {
        const std::vector<double> row = meant(candidates[c].values);
        for (std::size_t i = candidates[c].shots; i < shots; ++i) {
            const Draw d = draw(i);
            owner.push_back(c);
            columns[0].push_back(row[0] + turned + d.aim);
            Cue cue = *scene_.cue;
            cue.speed = row[1] * (1.0 + d.speed);
            cue.side = row[2] + d.side;
            cue.height = row[3] + d.height;
            cue.elevation_deg = row[4] + d.elevation;
            cue = legal_strike(cue);
            columns[1].push_back(cue.speed);
            columns[2].push_back(cue.side);
            columns[3].push_back(cue.height);
            columns[4].push_back(cue.elevation_deg);
            for (std::size_t k = 5; k < chosen_; ++k) columns[k].push_back(row[k]);
            if (columns_.empty()) continue;
            const std::vector<double>& values = table(i);
            for (std::size_t k = 0; k < columns_.size(); ++k) {
                std::vector<double>& column = columns[columns_[k]];
                // A chosen number differs from the choice as the table's differs from the scene's.
                if (columns_[k] < chosen_)
                    column.back() += values[k] - usual_[k];
                else
                    column.push_back(values[k]);
            }
        }
    }
    std::vector<BatchColumn> batch;
    for (std::size_t k = 0; k < keys_.size(); ++k) batch.push_back({keys_[k], columns[k]});
    std::vector<std::uint8_t> held(rows, 0);
    BatchOptions how;
    how.threads = options_.threads;
    how.stop = options_.stop;
    how.judge = [&](std::size_t shot, const Outcome&, const Record& record) {
        held[shot] = record.stopped == StopReason::kAtRest && want_.holds(record);
        if (look) look(shot, record);
    };
    std::vector<ShotStatus> status(rows);
    BatchArrays out;
    out.status = status.data();
    simulate_many(scene_, rows, batch, isa_, how, out);
    for (std::size_t i = 0; i < rows; ++i) {
        candidates[owner[i]].successes += held[i];
        candidates[owner[i]].invalid += status[i] == ShotStatus::kInvalid ? 1 : 0;
    }
    for (Candidate& candidate : candidates) candidate.shots = std::max(candidate.shots, shots);
    played_ += rows;
    if (options_.progress) options_.progress(std::min(played_, options_.shots));
}

}  // namespace carom::games::detail
