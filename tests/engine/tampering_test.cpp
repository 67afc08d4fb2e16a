// No tampered record passes --verify: 76 kinds of tampering at seeded places of records of 16 scenes. The
// list with the laws that find them is in docs/design/hard_cases.md. CAROM_TAMPERINGS=1 prints the table.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "carom/engine/cushion.h"
#include "physics/motion.h"
#include "reference/random_impacts.h"
#include "support/crowded_scenes.h"
#include "support/engine_cases.h"
#include "support/scenes.h"

namespace carom::test {
namespace {

using reference::Generator;

int draw(Generator& random, std::size_t count) {
    return std::min(static_cast<int>(count) - 1,
                    static_cast<int>(random.uniform(0.0, static_cast<double>(count))));
}

/// A seeded choice among the items that a condition admits.
template <class Item, class Admits>
Item* one_of(std::vector<Item>& items, Generator& random, const Admits& admits) {
    std::vector<Item*> some;
    for (Item& item : items)
        if (admits(item)) some.push_back(&item);
    return some.empty() ? nullptr : some[static_cast<std::size_t>(draw(random, some.size()))];
}

struct Place {
    BallTrack* track = nullptr;
    std::size_t k = 0;
    Segment& at() const { return track->segments[k]; }
};

/// A seeded segment; `admits` gets its track and its index.
template <class Admits>
std::optional<Place> segment(Record& record, Generator& random, const Admits& admits) {
    std::vector<Place> some;
    for (BallTrack& track : record.tracks)
        for (std::size_t k = 0; k < track.segments.size(); ++k)
            if (admits(track, k)) some.push_back({&track, k});
    if (some.empty()) return std::nullopt;
    return some[static_cast<std::size_t>(draw(random, some.size()))];
}

/// Whether a segment that lasts, free of resting contacts before and after, has this state.
auto is(MotionState state) {
    return [state](const BallTrack& track, std::size_t k) {
        const std::vector<Segment>& s = track.segments;
        const bool lasts = k + 1 == s.size() || s[k + 1].start > s[k].start + 1e-3;
        return s[k].state == state && !s[k].held && lasts;
    };
}

/// A free motion after an impact that nothing else meets at the same instant.
bool is_free_after(const Record& record, const BallTrack& track, std::size_t k) {
    const std::vector<Segment>& s = track.segments;
    if (k == 0 || s[k].held || s[k - 1].held || s[k - 1].state == MotionState::kColliding ||
        s[k].state == MotionState::kColliding || s[k].v.norm() < 0.02)
        return false;
    if (!(s[k].start > s[k - 1].start) || (k + 1 < s.size() && !(s[k + 1].start > s[k].start))) return false;
    const auto ball = static_cast<int>(&track - record.tracks.data());
    bool impact = false, alone = true;
    for (const Event& e : record.events) {
        if (e.time != s[k].start) continue;
        const EventKind& of = kind(e.type);
        const bool has = e.a == ball || (of.partner == Partner::kBall && e.b == ball);
        impact |= has && of.phase == EventPhase::kImpact && e.type != EventType::kBallCluster &&
                  of.partner != Partner::kPocket;
        alone &= of.phase == EventPhase::kImpact && e.type != EventType::kBallCluster;
    }
    return impact && alone;
}

/// Whether a ball of the event is in a resting contact before or after it: a group may change its velocities.
bool in_group(const Record& record, const Event& e) {
    for (const BallTrack& t : record.tracks)
        for (const Segment& s : t.segments)
            if (s.held && s.start - 1e-12 <= e.time && e.time <= s.start + s.duration + 1e-12) return true;
    return false;
}

/// Whether a ball of a cluster is above the cloth.
bool in_air(const Record& record, const Event& e) {
    const std::vector<int>& balls = record.clusters[static_cast<std::size_t>(e.detail)].balls;
    return std::any_of(balls.begin(), balls.end(), [&](int ball) {
        const BallTrack& t = record.tracks[static_cast<std::size_t>(ball)];
        const std::size_t k = t.segment_at(e.time);
        return is_off_cloth(t.segments[k == 0 ? 0 : k - 1].state) || t.segments[k].v.z() != 0.0 ||
               t.segments[k].r.z() != record.size(ball).R;
    });
}

using Spoil = std::function<bool(Record&, Generator&)>;
struct Kind {
    const char *name, *laws;  ///< the laws that may find it
    Spoil spoil;
};

/// Whether the record contradicts the absence of an event: not if another event of its instant leaves the
/// velocities open (a cluster in the air, an impact in a group), or if a contact that never ends begins
/// beside another one.
bool is_needed(const Record& record, const Event& event) {
    const EventPhase phase = kind(event.type).phase;
    if (phase == EventPhase::kImpact && kind(event.type).partner != Partner::kPocket &&
        in_group(record, event))
        return false;
    bool released = false, alone = true, cluster = false;
    const BallTrack& track = record.tracks[static_cast<std::size_t>(event.a)];
    const std::size_t now = track.segment_at(event.time);
    const bool rested = now > 0 && track.segments[now - 1].held;
    for (const Event& e : record.events) {
        if (&e == &event) continue;
        released |= kind(e.type).phase == EventPhase::kRelease && e.time > event.time && e.a == event.a &&
                    e.b == event.b;
        alone &= e.time != event.time;
        cluster |= e.time == event.time && e.type == EventType::kBallCluster;
    }
    return phase == EventPhase::kHold ? released || (alone && !rested)
                                      : !cluster || event.type == EventType::kBallCluster;
}

Spoil without(EventType type) {
    return [type](Record& r, Generator& random) {
        Event* e = one_of(r.events, random,
                          [&](const Event& event) { return event.type == type && is_needed(r, event); });
        if (e != nullptr) r.events.erase(r.events.begin() + (e - r.events.data()));
        return e != nullptr;
    };
}

/// Changes an event that is admitted.
template <class Admits, class Change>
Spoil event(const Admits& admits, const Change& change) {
    return [=](Record& r, Generator& random) {
        Event* e = one_of(r.events, random, admits);
        return e != nullptr && change(r, *e, random);
    };
}

template <class Admits, class Change>
Spoil motion(Admits admits, Change change) {
    return [=](Record& r, Generator& random) {
        const auto place =
            segment(r, random, [&](const BallTrack& t, std::size_t k) { return admits(r, t, k); });
        if (!place) return false;
        change(r, *place);
        return true;
    };
}

bool any_event(const Event&) {
    return true;
}

bool has_partner(const Event& e, Partner partner) {
    return kind(e.type).partner == partner;
}

auto lasting(MotionState state) {
    return [state](const Record&, const BallTrack& t, std::size_t k) { return is(state)(t, k); };
}

/// After it the ball moves no more.
void stop_dead(Record& r, const Place& place) {
    Segment rest;
    rest.start = place.at().start;
    rest.r = place.at().r;
    rest.v = rest.w = Vec3::Zero();
    rest.a = rest.dw = Vec2::Zero();
    rest.duration = std::numeric_limits<double>::infinity();
    place.track->segments.resize(place.k);
    place.track->segments.push_back(rest);
    (void)r;
}

std::vector<Kind> kinds() {
    const auto another = [](int index, std::size_t count, Generator& random) {
        return (index + 1 + draw(random, count - 1)) % static_cast<int>(count);
    };
    std::vector<Kind> all;
    const auto add = [&all](const char* name, const char* laws, Spoil spoil) {
        all.push_back({name, laws, std::move(spoil)});
    };
    add("all events are gone", "U6", [](Record& r, Generator&) {
        const bool any = !r.events.empty();
        r.events.clear();
        return any;
    });
    add("a number is NaN", "U1",
        motion([](auto&, auto&, std::size_t) { return true; },
               [](Record&, const Place& p) { p.at().v.y() = std::numeric_limits<double>::quiet_NaN(); }));
    add("an event is 20 ms late", "U5 U6", [](Record& r, Generator& random) {
        Event* e = one_of(r.events, random, any_event);
        if (e == nullptr) return false;
        e->time += 0.02;
        std::stable_sort(r.events.begin(), r.events.end(),
                         [](const Event& p, const Event& q) { return p.time < q.time; });
        return true;
    });
    add("all events are 20 ms late", "U6", [](Record& r, Generator&) {
        for (Event& e : r.events) e.time += 0.02;
        return !r.events.empty();
    });
    add("two events are exchanged", "U2", [](Record& r, Generator&) {
        if (r.events.size() < 2 || r.events.front().time == r.events.back().time) return false;
        std::swap(r.events.front(), r.events.back());
        return true;
    });
    add("an event is twice in the list", "U5 U6",
        event(
            [](const Event& e) {
                return kind(e.type).phase != EventPhase::kRelease &&
                       kind(e.type).phase != EventPhase::kHold && e.type != EventType::kBallCluster &&
                       e.type != EventType::kBallOut && kind(e.type).phase != EventPhase::kStrike &&
                       kind(e.type).partner != Partner::kPocket &&
                       kind(e.type).phase != EventPhase::kTransition;
            },
            [](Record& r, Event& e, Generator&) {
                if (!is_needed(r, e)) return false;
                const Event copy = e;
                r.events.insert(r.events.begin() + (&e - r.events.data()), copy);
                return true;
            }));
    add("an event names another ball", "U5 U6",
        event(any_event, [another](Record& r, Event& e, Generator& random) {
            // Any two of its balls may have met first.
            if (r.tracks.size() < 3 || e.type == EventType::kBallCluster) return false;
            e.a = another(e.a, r.tracks.size(), random);
            return !has_partner(e, Partner::kBall) || e.a != e.b;
        }));
    add("an impact names another partner", "U5 U6",
        event([](const Event& e) { return e.type == EventType::kBallBall; },
              [another](Record& r, Event& e, Generator& random) {
                  if (r.tracks.size() < 3) return false;
                  e.b = another(e.b, r.tracks.size(), random);
                  return e.a != e.b;
              }));
    add("an impact names another cushion", "U6",
        event([](const Event& e) { return e.type == EventType::kBallCushion && e.detail < 0; },
              [another](Record& r, Event& e, Generator& random) {
                  if (r.table.cushions.size() < 2) return false;
                  e.b = another(e.b, r.table.cushions.size(), random);
                  return true;
              }));
    add("a jaw becomes another", "U6",
        event([](const Event& e) { return e.type == EventType::kBallJaw; },
              [another](Record& r, Event& e, Generator& random) {
                  if (r.table.jaws.size() < 2) return false;
                  e.b = another(e.b, r.table.jaws.size(), random);
                  return true;
              }));
    add("a ball falls into another pocket", "U6",
        event([](const Event& e) { return e.type == EventType::kBallPocket; },
              [another](Record& r, Event& e, Generator& random) {
                  e.b = another(e.b, r.table.pockets.size(), random);
                  r.tracks[static_cast<std::size_t>(e.a)].pocket = e.b;
                  return true;
              }));
    add("a ball passes the edge of another pocket", "U6",
        event([](const Event& e) { return e.type == EventType::kBallEdge; },
              [another](Record& r, Event& e, Generator& random) {
                  e.b = another(e.b, r.table.pockets.size(), random);
                  return true;
              }));
    add("a pocketed ball lies in another pocket", "U8", [another](Record& r, Generator& random) {
        BallTrack* t = one_of(r.tracks, random, [](const BallTrack& of) { return of.pocket >= 0; });
        if (t != nullptr) t->pocket = another(t->pocket, r.table.pockets.size(), random);
        return t != nullptr;
    });
    add("a pocketed ball is not in a pocket", "U8", [](Record& r, Generator& random) {
        BallTrack* t = one_of(r.tracks, random, [](const BallTrack& of) { return of.pocket >= 0; });
        if (t != nullptr) t->pocket = -1;
        return t != nullptr;
    });
    add("a ball is pocketed without reason", "U5 U6", [](Record& r, Generator& random) {
        if (r.table.pockets.empty()) return false;
        const auto p = segment(r, random, [](const BallTrack& t, std::size_t k) {
            return k > 0 && (is(MotionState::kRolling)(t, k) || is(MotionState::kSliding)(t, k));
        });
        if (!p) return false;
        const int pocket = draw(random, r.table.pockets.size());
        const Pocket& of = r.table.pockets[static_cast<std::size_t>(pocket)];
        stop_dead(r, *p);
        p->at().state = MotionState::kPocketed;
        p->at().r = Vec3(of.center.x(), of.center.y(), -of.depth);
        p->track->pocket = pocket;
        const Event e{p->at().start, EventType::kBallPocket, static_cast<int>(p->track - r.tracks.data()),
                      pocket};
        std::erase_if(r.events, [&](const Event& x) { return x.a == e.a && x.time >= e.time; });
        r.events.insert(
            std::find_if(r.events.begin(), r.events.end(), [&](const Event& x) { return x.time > e.time; }),
            e);
        return true;
    });
    add("a transition has another type", "U6",
        event(
            [](const Event& e) {
                return kind(e.type).phase == EventPhase::kTransition && !has_partner(e, Partner::kPocket) &&
                       e.type != EventType::kBallOut;
            },
            [](Record&, Event& e, Generator&) {
                e.type = e.type == EventType::kSlideRoll ? EventType::kRollStop : EventType::kSlideRoll;
                return true;
            }));
    add("a cluster lacks a ball", "U6",
        event([](const Event& e) { return e.type == EventType::kBallCluster; },
              [](Record& r, Event& e, Generator& random) {
                  if (in_group(r, e)) return false;
                  std::vector<int>& list = r.clusters[static_cast<std::size_t>(e.detail)].balls;
                  list.erase(list.begin() + draw(random, list.size()));
                  return true;
              }));
    add("a cluster has one more ball", "U6",
        event([](const Event& e) { return e.type == EventType::kBallCluster; },
              [](Record& r, Event& e, Generator&) {
                  std::vector<int>& list = r.clusters[static_cast<std::size_t>(e.detail)].balls;
                  for (int ball = 0; ball < static_cast<int>(r.tracks.size()); ++ball) {
                      if (std::find(list.begin(), list.end(), ball) != list.end()) continue;
                      const BallTrack& t = r.tracks[static_cast<std::size_t>(ball)];
                      if (t.segments[t.segment_at(e.time)].start == e.time) continue;
                      list.push_back(ball);
                      return true;
                  }
                  return false;
              }));
    const auto hit = [](const auto& change) {
        return event([](const Event& e) { return e.type == EventType::kBallCluster; },
                     [change](Record& r, Event& e, Generator& random) {
                         if (in_air(r, e) || r.state_at(e.a, e.time).state != MotionState::kColliding)
                             return false;
                         std::vector<Hit>& hits = r.clusters[static_cast<std::size_t>(e.detail)].hits;
                         double strongest = 0.0;
                         for (const Hit& h : hits) strongest = std::max(strongest, h.impulse);
                         Hit* h = one_of(hits, random, [strongest](const Hit& x) {
                             return x.partner == Partner::kBall && x.impulse > 0.5 * strongest;
                         });
                         return h != nullptr && !in_group(r, e) && change(hits, *h);
                     });
    };
    add("a strong hit of a cluster is missing", "U5", hit([](std::vector<Hit>& hits, Hit& h) {
            hits.erase(hits.begin() + (&h - hits.data()));
            return true;
        }));
    add("a strong hit of a cluster is three times as strong", "U5", hit([](std::vector<Hit>&, Hit& h) {
            h.impulse *= 3.0;
            return true;
        }));
    add("a hit is of a ball outside of the cluster, or of one ball", "U6", hit([](std::vector<Hit>&, Hit& h) {
            h.b = h.a;
            return true;
        }));
    add("a hit is earlier than its cluster", "U6", hit([](std::vector<Hit>&, Hit& h) {
            h.time *= 0.99;
            return h.time > 0.0;
        }));
    add("two balls at rest meet", "U6", [](Record& r, Generator& random) {
        if (r.tracks.size() < 2 || r.events.empty()) return false;
        const int a = draw(random, r.tracks.size()), b = (a + 1) % static_cast<int>(r.tracks.size());
        const double t = 0.5 * r.duration;
        r.events.insert(
            std::find_if(r.events.begin(), r.events.end(), [&](const Event& x) { return x.time > t; }),
            Event{t, EventType::kBallBall, a, b});
        return true;
    });
    add("the velocity after an impact is 1 % larger", "U4 U5 U7",
        motion(is_free_after, [](Record&, const Place& p) { p.at().v *= 1.01; }));
    add("the velocity after an impact is 1e-4 smaller", "U5 U7",
        motion(is_free_after, [](Record&, const Place& p) { p.at().v *= 1.0 - 1e-4; }));
    add("the velocity after an impact is 1e-4 smaller, with the motion that follows", "U5 U7",
        motion([](const Record& r, const BallTrack& t,
                  std::size_t k) { return is_free_after(r, t, k) && !is_off_cloth(t.segments[k].state); },
               [](Record& r, const Place& p) {
                   const Segment& s = p.at();
                   MotionParams params = motion_params(r.balls, r.gravity, s.r.z());
                   p.at() = start_segment(s.start, s.r, (1.0 - 1e-4) * s.v, s.w, params);
               }));
    add("an impact and the motion after it turn by 1 degree", "U5",
        motion(
            [](const Record& r, const BallTrack& t, std::size_t k) {
                return is_free_after(r, t, k) && t.segments[k].state != MotionState::kRolling;
            },
            [](Record&, const Place& p) {
                const double c = std::cos(0.01745), s = std::sin(0.01745);
                Segment& at = p.at();
                for (auto* v : {&at.v, &at.w})
                    *v = Vec3(c * v->x() - s * v->y(), s * v->x() + c * v->y(), v->z());
                for (auto* v : {&at.a, &at.dw}) *v = Vec2(c * v->x() - s * v->y(), s * v->x() + c * v->y());
            }));
    add("an impact's velocity is mirrored", "U5 U7", motion(is_free_after, [](Record&, const Place& p) {
            const Vec3 came = p.track->segments[p.k - 1].v;
            Vec3& v = p.at().v;
            v = came.norm() > 1e-3 && (came + v).norm() > 1e-3 ? Vec3(-v) : Vec3(-0.5 * v);
        }));
    add("the spin after an impact is 1 % larger", "U5 U7",
        motion([](const Record& r, const BallTrack& t,
                  std::size_t k) { return is_free_after(r, t, k) && t.segments[k].w.norm() > 1.0; },
               [](Record&, const Place& p) { p.at().w *= 1.01; }));
    add("the vertical spin is 0 from one motion on", "U5 U6 U7",
        motion(
            [](const Record&, const BallTrack& t, std::size_t k) {
                return !t.segments[k].held &&
                       (k == 0 ||
                        (!t.segments[k - 1].held && t.segments[k - 1].state != MotionState::kColliding &&
                         t.segments[k - 1].start < t.segments[k].start)) &&
                       t.segments[k].state != MotionState::kColliding &&
                       std::abs(t.segments[k].w.z()) > 0.1 &&
                       (k + 1 == t.segments.size() || t.segments[k + 1].start > t.segments[k].start);
            },
            [](Record&, const Place& p) {
                for (std::size_t k = p.k; k < p.track->segments.size(); ++k) {
                    p.track->segments[k].w.z() = p.track->segments[k].spin_decay = 0.0;
                }
            }));
    add("a ball stops dead", "U5 U6 U7",
        motion([](const Record& r, const BallTrack& t, std::size_t k) { return is_free_after(r, t, k); },
               stop_dead));
    add("a rolling ball stops dead in the middle", "U6",
        motion(lasting(MotionState::kRolling), [](Record& r, const Place& p) {
            const double until =
                p.k + 1 < p.track->segments.size() ? p.track->segments[p.k + 1].start : r.duration;
            const double t = 0.5 * (p.at().start + until);
            Segment half = p.at();
            half.start = t;
            half.r = r.state_at(static_cast<int>(p.track - r.tracks.data()), t).position;
            p.track->segments.insert(p.track->segments.begin() + static_cast<std::ptrdiff_t>(p.k) + 1, half);
            stop_dead(r, {p.track, p.k + 1});
        }));
    add("a ball that was hit never moves", "U6",
        motion(
            [](const Record&, const BallTrack& t, std::size_t k) {
                return k == 0 && t.segments.size() > 2 && t.segments[0].state == MotionState::kStationary &&
                       t.segments[1].start > 0.0;
            },
            [](Record&, const Place& p) { p.track->segments.resize(1); }));
    add("a ball rolls with half the deceleration", "U7",
        motion([](const Record&, const BallTrack& t,
                  std::size_t k) { return is(MotionState::kRolling)(t, k) && t.segments[k].a.norm() > 0.0; },
               [](Record&, const Place& p) { p.at().a *= 0.5, p.at().dw *= 0.5, p.at().duration *= 2.0; }));
    add("a ball slides with less friction", "U7",
        motion([](const Record&, const BallTrack& t,
                  std::size_t k) { return is(MotionState::kSliding)(t, k) && t.segments[k].a.norm() > 0.0; },
               [](Record&, const Place& p) { p.at().a *= 0.99; }));
    add("the friction of a sliding ball has another direction", "U7",
        motion([](const Record&, const BallTrack& t,
                  std::size_t k) { return is(MotionState::kSliding)(t, k) && t.segments[k].a.norm() > 0.0; },
               [](Record&, const Place& p) { p.at().a = Vec2(-p.at().a.y(), p.at().a.x()); }));
    add("the spin of a sliding ball does not change", "U7",
        motion([](const Record&, const BallTrack& t,
                  std::size_t k) { return is(MotionState::kSliding)(t, k) && t.segments[k].dw.norm() > 0.0; },
               [](Record&, const Place& p) { p.at().dw = Vec2::Zero(); }));
    add("the vertical spin decays at half the rate", "U7",
        motion(
            [](const Record&, const BallTrack& t, std::size_t k) { return t.segments[k].spin_decay > 0.0; },
            [](Record&, const Place& p) { p.at().spin_decay *= 0.5; }));
    add("a motion lasts 1 % longer", "U7",
        motion(
            [](const Record&, const BallTrack& t, std::size_t k) {
                return !t.segments[k].held && std::isfinite(t.segments[k].duration) &&
                       t.segments[k].duration > 1e-4 && t.segments[k].state != MotionState::kColliding;
            },
            [](Record&, const Place& p) { p.at().duration *= 1.01; }));
    add("a sliding ball is called rolling", "U7",
        motion(lasting(MotionState::kSliding),
               [](Record&, const Place& p) { p.at().state = MotionState::kRolling; }));
    add("a rolling ball is called sliding", "U7",
        motion(lasting(MotionState::kRolling),
               [](Record&, const Place& p) { p.at().state = MotionState::kSliding; }));
    add("a rolling ball slips", "U7",
        motion(lasting(MotionState::kRolling), [](Record&, const Place& p) { p.at().w.x() += 1.0; }));
    add("a flying ball is called sliding", "U6 U7",
        motion(lasting(MotionState::kAirborne),
               [](Record&, const Place& p) { p.at().state = MotionState::kSliding; }));
    add("a flying ball rises faster", "U5 U7",
        motion(lasting(MotionState::kAirborne), [](Record&, const Place& p) { p.at().v.z() += 0.01; }));
    add("a falling ball falls faster", "U6 U7",
        motion([](const Record&, const BallTrack& t,
                  std::size_t k) { return t.segments[k].state == MotionState::kFalling; },
               [](Record&, const Place& p) { p.at().v.z() -= 0.01; }));
    add("a ball rises above the cloth", "U7",
        motion(
            [](const Record&, const BallTrack& t, std::size_t k) {
                return is(MotionState::kRolling)(t, k) || is(MotionState::kStationary)(t, k);
            },
            [](Record&, const Place& p) { p.at().r.z() += 1e-4; }));
    add("the last motion of a ball is 0.2 m away", "U6",
        motion(
            [](const Record&, const BallTrack& t, std::size_t k) {
                return k + 1 == t.segments.size() && t.segments[k].state != MotionState::kPocketed;
            },
            [](Record&, const Place& p) { p.at().r.x() += 0.2; }));
    add("a motion is 0.01 mm away", "U6",
        motion(
            [](const Record&, const BallTrack& t, std::size_t k) {
                return k + 1 == t.segments.size() || t.segments[k + 1].start > t.segments[k].start;
            },
            [](Record&, const Place& p) { p.at().r.y() += 1e-5; }));
    add("a ball begins elsewhere", "U6",
        motion([](const Record&, const BallTrack&, std::size_t k) { return k == 0; },
               [](Record&, const Place& p) {
                   for (Segment& s : p.track->segments) s.r.x() += 1e-3;
               }));
    add("a motion begins 1 ms later", "U6 U7",
        motion(
            [](const Record&, const BallTrack& t, std::size_t k) {
                return k > 0 && k + 1 < t.segments.size() &&
                       t.segments[k + 1].start > t.segments[k].start + 0.002;
            },
            [](Record&, const Place& p) { p.at().start += 1e-3; }));
    add("a motion begins before the one before it", "U2",
        motion([](const Record&, const BallTrack& t,
                  std::size_t k) { return k > 0 && t.segments[k - 1].start > 1e-3; },
               [](Record&, const Place& p) { p.at().start = p.track->segments[p.k - 1].start - 1e-4; }));
    add("a motion is left out", "U6 U7 U8",
        motion(
            [](const Record&, const BallTrack& t, std::size_t k) {
                return k > 0 && t.segments[k].start > t.segments[k - 1].start &&
                       (k + 1 == t.segments.size() || t.segments[k + 1].start > t.segments[k].start) &&
                       !t.segments[k].held && !t.segments[k - 1].held &&
                       t.segments[k].state != MotionState::kColliding;
            },
            [](Record&, const Place& p) {
                p.track->segments.erase(p.track->segments.begin() + static_cast<std::ptrdiff_t>(p.k));
            }));
    add("a motion is cut in two, with another velocity", "U6 U7",
        motion(
            [](const Record&, const BallTrack& t, std::size_t k) {
                return !t.segments[k].held && translates(t.segments[k].state) &&
                       t.segments[k].state != MotionState::kColliding && k + 1 < t.segments.size() &&
                       t.segments[k + 1].start > t.segments[k].start + 1e-3;
            },
            [](Record& r, const Place& p) {
                const double t = 0.5 * (p.at().start + p.track->segments[p.k + 1].start);
                const BallState s = r.state_at(static_cast<int>(p.track - r.tracks.data()), t);
                Segment half = p.at();
                half.start = t, half.r = s.position, half.v = 0.9 * s.velocity, half.w = s.spin;
                p.track->segments.insert(p.track->segments.begin() + static_cast<std::ptrdiff_t>(p.k) + 1,
                                         half);
            }));
    add("two balls exchange their motions", "U6", [](Record& r, Generator& random) {
        if (r.tracks.size() < 2) return false;
        const int a = draw(random, r.tracks.size() - 1);
        std::swap(r.tracks[static_cast<std::size_t>(a)].segments,
                  r.tracks[static_cast<std::size_t>(a) + 1].segments);
        return true;
    });
    add("all times are 1 % longer", "U6 U7", [](Record& r, Generator&) {
        for (BallTrack& t : r.tracks)
            for (Segment& s : t.segments) s.start *= 1.01;
        for (Event& e : r.events) e.time *= 1.01;
        r.duration *= 1.01;
        return r.duration > 0.0 && r.events.size() > 1;
    });
    add("the strike is 0.1 % faster", "U5 U7", [](Record& r, Generator&) {
        if (r.events.empty() || r.events[0].type != EventType::kCueStrike) return false;
        std::vector<Segment>& s = r.tracks[static_cast<std::size_t>(r.events[0].a)].segments;
        if (s.size() < 2 || s[1].start > 0.0) return false;
        s[1].v *= 1.001;
        return true;
    });
    add("a cluster lasts longer for one ball", "U6 U7",
        motion(lasting(MotionState::kColliding), [](Record&, const Place& p) { p.at().duration *= 1.1; }));
    add("a ball in a cluster follows another path", "U6",
        motion([](const Record&, const BallTrack& t,
                  std::size_t k) { return t.segments[k].state == MotionState::kColliding; },
               [](Record&, const Place& p) { p.at().v += Vec3(0.1, -0.1, 0.0); }));
    add("the spin after a cluster differs from that in it", "U6",
        motion([](const Record&, const BallTrack& t,
                  std::size_t k) { return t.segments[k].state == MotionState::kColliding; },
               [](Record&, const Place& p) { p.at().w.z() += 1.0; }));
    add("a cluster makes a ball twice as fast", "U4 U5 U7",
        motion(
            [](const Record&, const BallTrack& t, std::size_t k) {
                return k > 0 && t.segments[k - 1].state == MotionState::kColliding &&
                       t.segments[k].v.norm() > 0.5;
            },
            [](Record&, const Place& p) { p.at().v *= 2.0; }));
    add("the record ends twice as late", "U7 U8", [](Record& r, Generator&) {
        r.duration *= 2.0;
        return r.duration > 0.0;
    });
    add("the record ends before its last change", "U8", [](Record& r, Generator&) {
        if (r.stopped == StopReason::kTime) return false;
        r.duration *= 0.9;
        return r.duration > 0.0;
    });
    add("the record stopped for another reason", "U8", [](Record& r, Generator&) {
        r.stopped = r.stopped == StopReason::kAtRest ? StopReason::kTime : StopReason::kAtRest;
        return true;
    });
    add("a ball in the end does not rest", "U6 U7 U8",
        motion(
            [](const Record& r, const BallTrack& t, std::size_t k) {
                return r.stopped == StopReason::kAtRest && k > 0 && k + 1 == t.segments.size() &&
                       t.segments[k].start > t.segments[k - 1].start &&
                       t.segments[k].state == MotionState::kStationary && !t.segments[k].held &&
                       !t.segments[k - 1].held;
            },
            [](Record&, const Place& p) { p.track->segments.pop_back(); }));

    for (int type = 0; type < kEventTypes; ++type) {
        const EventKind& of = kEventKinds[type];
        static std::vector<std::string> names;
        names.reserve(kEventTypes);
        // A held ball says by its state that a contact holds it; the end of a contact is known only from its
        // event.
        if (of.phase == EventPhase::kRelease) continue;
        names.push_back(std::string("no event ") + of.name);
        all.push_back({names.back().c_str(), "U4 U5 U6 U8", without(of.type)});
    }
    return all;
}

struct Named {
    std::string name;
    Scene scene;
};

std::vector<Named> scenes() {
    std::vector<Named> all;
    for (const char* name : {"draw", "side_bank", "eight_ball_break", "three_cushion", "nine_ball_break",
                             "snooker_break", "raised_break", "jump_pot", "heavy_cue_ball", "masse"})
        all.push_back({name, shipped(name)});
    for (const char* family : {"touching", "rail_cluster", "jaw_wedge"})
        all.push_back({family, *family_scene(family, 3)});
    Scene round = empty_scene();
    round.table.jaws.push_back({"w", {0.0, 0.0}, 0.5, round.balls.R, "", "inside", 0.0, 360.0});
    add_ball(round, "a", 0.1, 0.05, 1.0, 0.3);
    add_ball(round, "b", -0.1, 0.2, 0.2, -0.5);
    all.push_back({"round wall", round});
    Scene pressed = empty_scene();
    pressed.table = box(1.0, 1.0, 0.036576);
    pressed.table.jaws.push_back({"j", {0.5, 0.5}, 0.1, 0.036576});
    add_ball(pressed, "a", pressed.balls.R, 0.3, 0.0, 0.0, {3.0, -60.0, 0.0});
    add_ball(pressed, "b", 0.5, 0.4 - pressed.balls.R, 0.0, 0.0, {-40.0, 1.0, 0.0});
    all.push_back({"pressed", pressed});
    Scene pucks = empty_scene();
    pucks.balls.slides = true;
    pucks.balls.mu_b = pucks.balls.f_c = 0.0;
    pucks.balls.mu_s = 0.02;
    pucks.physics.ball_ball = ball_ball_model("elastic");
    pucks.table = box(0.8, 1.6, pucks.balls.R);
    add_ball(pucks, "a", 0.2, 0.3, 0.4, 1.5, {0.0, 0.0, 20.0});
    add_ball(pucks, "b", 0.5, 0.9);
    add_ball(pucks, "c", 0.3, 1.2, -0.5, 0.2);
    all.push_back({"pucks", pucks});
    return all;
}

TEST(Tampering, IsAlwaysFound) {
    const bool prints = std::getenv("CAROM_TAMPERINGS") != nullptr;
    Generator random(80);
    const std::vector<Kind> all = kinds();
    std::vector<int> done(all.size()), unseen(all.size());
    std::vector<std::set<std::string>> laws(all.size());
    std::map<std::string, int> missed;
    for (const Named& of : scenes()) {
        const Plan plan = plan_of(of.scene);
        const Record good = simulate(plan);
        const auto wrong = verify(good, plan);
        ASSERT_FALSE(wrong) << of.name << ": " << wrong->law << " " << wrong->message;
        for (std::size_t k = 0; k < all.size(); ++k) {
            for (int place = 0; place < 10; ++place) {
                Record bad = good;
                if (!all[k].spoil(bad, random)) break;
                ++done[k];
                const auto found = verify(bad, plan);
                EXPECT_TRUE(found) << all[k].name << " in " << of.name;
                unseen[k] += found ? 0 : 1;
                if (!found) continue;
                laws[k].insert(found->law);
                EXPECT_NE(std::string(all[k].laws).find(found->law), std::string::npos)
                    << all[k].name << " in " << of.name << ": " << found->law << " " << found->message;
            }
        }
    }
    EXPECT_GE(all.size(), 40u);
    for (std::size_t k = 0; k < all.size(); ++k) {
        EXPECT_GT(done[k], 0) << all[k].name;
        if (!prints) continue;
        std::string list;
        for (const std::string& law : laws[k]) list += law + " ";
        std::printf("| %s | %s| %d | %d |\n", all[k].name, list.c_str(), done[k], unseen[k]);
    }
}

}  // namespace
}  // namespace carom::test
