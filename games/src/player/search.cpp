#include "player/search.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "carom/engine/batch.h"
#include "carom/engine/math.h"
#include "carom/games/shot.h"
#include "facts.h"
#include "player/description.h"
#include "unknown.h"

namespace carom::games::detail {
namespace {

/// Shots of a candidate in each round, and candidates kept after the first ones.
constexpr std::array<std::size_t, 3> kWholeSamples{4, 8, 24}, kQuickSamples{6, 12, 36};
constexpr std::array<std::size_t, 2> kKeep{12, 4};
/// [-] Cost of a foul for a player who ignores the position that a shot leaves.
constexpr double kFoulCost = 0.3;

double sd_of_aim(const Noise& noise) {
    // A side offset of the tip by a tenth of a radius turns the ball's path by some tenths of a degree.
    constexpr double kTurnOfSide = 2.0;  // degrees a radius
    return length(Vec2(noise.aim_deg, noise.side * kTurnOfSide)) / kDegrees;
}

}  // namespace

Search::Search(const State& state, Scene scene, const Skill& skill, kernel::Isa isa,
               const AdviceOptions& options)
    : state_(state),
      scene_(std::move(scene)),
      skill_(skill),
      isa_(isa),
      options_(options),
      potting_(scene_, sd_of_aim(skill.noise)),
      lie_(lie_of(scene_)),
      targets_(targets(state, lie_)),
      first_(0),
      cue_ball_(static_cast<std::size_t>(index_of(scene_.ball, scene_.cue->ball))),
      in_hand_(state.in_hand != InHand::kNo || state.opening) {
    const Legal allowed = legal(state, scene_);
    for (const std::string& id : allowed.first) first_ |= only(number_of(id));
    calls_ = !allowed.callable.empty();
}

void Search::play(std::span<const Cue> cues, std::span<const Vec2> places, const Judge& judge,
                  const std::vector<Scene>& tables) const {
    const std::string place = "ball." + scene_.cue->ball + ".position.";
    std::array<std::pair<std::string, std::vector<double>>, 7> numbers{{{"cue.speed", {}},
                                                                        {"cue.aim_deg", {}},
                                                                        {"cue.elevation_deg", {}},
                                                                        {"cue.offset.side", {}},
                                                                        {"cue.offset.height", {}},
                                                                        {place + "x", {}},
                                                                        {place + "y", {}}}};
    for (std::size_t i = 0; i < cues.size(); ++i) {
        const Cue& cue = cues[i];
        const double values[] = {cue.speed,  cue.aim_deg,   cue.elevation_deg, cue.side,
                                 cue.height, places[i].x(), places[i].y()};
        for (std::size_t k = 0; k < numbers.size(); ++k) numbers[k].second.push_back(values[k]);
    }
    std::vector<BatchColumn> columns;
    // A cue ball that is not in hand stays or is drawn, so its place needs no check.
    for (std::size_t k = 0; k < (in_hand_ ? 7 : 5); ++k)
        columns.push_back({numbers[k].first, numbers[k].second});
    const std::vector<bool> resized(scene_.ball.size());
    std::vector<std::string> keys;
    if (!tables.empty()) keys = table_keys(scene_, resized);
    std::vector<std::vector<double>> drawn(keys.size());
    for (std::size_t i = 0; i < cues.size() && !tables.empty(); ++i) {
        const std::vector<double> values = table_values(tables[i % tables.size()], resized);
        for (std::size_t k = 0; k < keys.size(); ++k) drawn[k].push_back(values[k]);
    }
    for (std::size_t k = 0; k < keys.size(); ++k)
        if (!in_hand_ || keys[k].rfind(place, 0) != 0) columns.push_back({keys[k], drawn[k]});
    BatchOptions batch;
    batch.threads = options_.threads;
    batch.stop = options_.stop;
    batch.judge = [&](std::size_t shot, const Outcome& outcome, const Record& record) {
        if (outcome.stopped == StopReason::kAtRest) judge(shot, record);
    };
    simulate_many(scene_, cues.size(), columns, isa_, batch, {});
}

std::pair<const Option*, double> Search::chosen(const Verdict& verdict, const Record& record) const {
    std::pair<const Option*, double> best{nullptr, 0.0};
    for (const Option& option : verdict.options) {
        const double worth = potting_.worth(option, record, state_.turn);
        const bool better = verdict.chooser == state_.turn ? worth > best.second : worth < best.second;
        if (best.first == nullptr || better) best = {&option, worth};
    }
    return best;
}

Search::Result Search::result(const Record& record, const Call& call, bool closer) const {
    const Verdict verdict = judge(state_, record, call);
    Result result;
    result.foul = !verdict.fouls.empty();
    const State& next = verdict.next();
    result.made = next.over ? next.winner == state_.turn : next.turn == state_.turn && !call.push_out;
    if (skill_.look == Look::kPot && !closer) {
        result.worth = result.made ? 1.0 : result.foul ? -kFoulCost : 0.0;
        return result;
    }
    const auto [taken, worth] = chosen(verdict, record);
    result.worth = worth;
    if (!closer || taken->state.over || taken->rerack()) return result;
    result.passed = taken->state.turn != state_.turn;
    const auto [ball, chance] = potting_.surest(taken->state, lie_of(record, *taken));
    if (result.passed)
        result.opponent = chance;
    else
        result.leaves = ball;
    return result;
}

void Search::rate(std::span<Attempt* const> candidates, std::size_t shots, std::size_t first,
                  bool closer) const {
    std::vector<Cue> cues;
    std::vector<Vec2> places;
    for (const Attempt* candidate : candidates) {
        const Noise noise = skill_.noise_at(candidate->cue.speed);
        for (std::size_t k = 0; k < shots; ++k) {
            cues.push_back(with_noise(candidate->cue, noise, options_.seed, first + k));
            places.push_back(candidate->place);
        }
    }
    std::vector<Scene> tables;
    for (std::size_t k = 0; k < shots && skill_.unknown != kExactTable; ++k)
        tables.push_back(drawn_table(scene_, skill_.unknown, options_.seed, first + k));
    std::vector<Result> results(cues.size());
    const auto rated = [&](std::size_t i, const Record& record) {
        results[i] = result(record, candidates[i / shots]->call, closer);
    };
    play(cues, places, rated, tables);
    for (std::size_t i = 0; i < results.size(); ++i) {
        Tally& tally = candidates[i / shots]->tally;
        ++tally.shots;
        tally.made += results[i].made;
        tally.fouls += results[i].foul;
        tally.worth += results[i].worth;
        tally.passed += results[i].passed;
        tally.opponent += results[i].opponent;
        ++tally.leaves[static_cast<std::size_t>(results[i].leaves)];
    }
}

void Search::describe(std::span<Attempt* const> candidates) const {
    std::vector<Cue> cues;
    std::vector<Vec2> places;
    for (const Attempt* candidate : candidates) {
        cues.push_back(candidate->cue);
        places.push_back(candidate->place);
    }
    play(cues, places, [&](std::size_t i, const Record& record) {
        Attempt& candidate = *candidates[i];
        const Shot shot = shot_of(record);
        candidate.spin = spin_words(record, shot);
        if (candidate.kind != ShotKind::kPot)
            candidate.rails = chain_words(record, shot, index_of(record, std::to_string(candidate.ball)));
        const Verdict verdict = judge(state_, record, candidate.call);
        const Option& next = *chosen(verdict, record).first;
        if (next.state.over || next.rerack() || shot.gone(shot.struck)) return;
        const Lie lie = lie_of(record, next);
        candidate.rest = place_words(scene_.table, *lie.cue);
        const auto [ball, chance] = potting_.surest(next.state, lie);
        if (ball > 0 && next.state.turn == state_.turn) candidate.rest += " for the " + std::to_string(ball);
    });
}

std::vector<Attempt*> Search::kept(std::vector<Attempt*> alive, std::size_t keep) const {
    std::stable_sort(alive.begin(), alive.end(),
                     [](const Attempt* a, const Attempt* b) { return a->tally.mean() > b->tally.mean(); });
    std::vector<Attempt*> kept;
    for (Attempt* candidate : alive) {
        // Advice must vary: keep two of every kind, ball and pocket as well, and a fair shot.
        const auto like = std::count_if(kept.begin(), kept.end(), [&](const Attempt* other) {
            return other->kind == candidate->kind && other->ball == candidate->ball &&
                   other->pocket == candidate->pocket && other->fouls() == candidate->fouls();
        });
        const bool fair = std::any_of(kept.begin(), kept.end(), [](const Attempt* a) { return !a->fouls(); });
        if (kept.size() < keep || (options_.best > 1 && like < 2) || (!fair && !candidate->fouls()))
            kept.push_back(candidate);
    }
    return kept;
}

std::vector<Attempt> Search::best() {
    std::vector<Attempt> candidates = this->candidates();
    std::vector<Attempt*> alive;
    alive.reserve(candidates.size());
    for (Attempt& candidate : candidates) alive.push_back(&candidate);
    const auto& samples = skill_.look == Look::kWhole ? kWholeSamples : kQuickSamples;
    std::size_t first = 0;
    for (std::size_t round = 0; round < samples.size(); ++round) {
        rate(alive, samples[round], first);
        first += samples[round];
        const std::size_t keep = round < kKeep.size() ? kKeep[round] : alive.size();
        alive = kept(std::move(alive), keep);
    }
    std::vector<Attempt> best;
    best.reserve(alive.size());
    for (const Attempt* candidate : alive) best.push_back(*candidate);
    return best;
}

}  // namespace carom::games::detail
