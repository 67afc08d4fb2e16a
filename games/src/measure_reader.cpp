// Reads an expression over measures into a tree.
#include <algorithm>
#include <cctype>
#include <charconv>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/as_number.h"
#include "measure_tree.h"

namespace carom::games::detail {
namespace {

using Node = Measure::Node;
// [m] The distance of `near` if none is given.
constexpr double kNear = 0.1;

/// The texts that a measure can return, besides "": their kind, and all of them.
struct Known {
    const char* what;
    Texts texts;
};
std::optional<Known> known_texts(std::string_view measure, const Scene& scene) {
    const auto ids = [](const auto& parts, Texts texts = {}) {
        for (const auto& part : parts) texts.push_back(part.id);
        return texts;
    };
    for (const char* name : {"pocketed", "off_table", "first_hit"})
        if (measure == name) return Known{"ball", ids(scene.ball)};
    if (measure == "pockets") return Known{"pocket", ids(scene.table.pockets)};
    if (measure == "pocket_of") return Known{"pocket", ids(scene.table.pockets, {"out"})};
    if (measure == "cushions")
        return Known{"cushion or jaw", ids(scene.table.jaws, ids(scene.table.cushions))};
    if (measure == "route") return Known{"rail", detail::rails_of(scene.table)};
    return std::nullopt;
}

/// Reads "left, foot" beside a list as its items, which tables join by ";".
void as_list(Node& text, const Node& measure) {
    const bool list = measure.row != nullptr && std::string_view(measure.row->info.unit) == "list";
    if (!list || text.kind != Node::Kind::kValue || !std::holds_alternative<Texts>(text.value)) return;
    std::string whole = text_of(text.value);
    for (std::size_t at = 0; (at = whole.find(", ", at)) != std::string::npos;) whole.replace(at, 2, 1, ';');
    text.value = Texts{whole};
}

/// Reads an expression by recursive descent, one function per level of precedence.
class MeasureReader {
  public:
    MeasureReader(const std::string& text, const Scene& scene, std::optional<Game> game)
        : text_(text), scene_(scene), game_(game) {
        next();
    }

    Node whole() {
        Node node = either();
        if (kind_ != Kind::kEnd) fail("expected the end, or an operator such as and, or, <");
        return node;
    }

  private:
    enum class Kind { kEnd, kNumber, kText, kName, kSign };

    [[noreturn]] void fail(const std::string& why) const {
        throw MeasureError("\"" + text_ + "\", at " +
                           (kind_ == Kind::kEnd ? "its end" : "\"" + token_ + "\"") + ": " + why);
    }

    void next() {
        while (at_ < text_.size() && text_[at_] == ' ') ++at_;
        token_.clear();
        kind_ = Kind::kEnd;
        if (at_ == text_.size()) return;
        const std::size_t begin = at_;
        const auto is = [&](auto test) {
            return at_ < text_.size() && test(static_cast<unsigned char>(text_[at_]));
        };
        const char c = text_[at_];
        if (c == '"') {
            kind_ = Kind::kText;
            const std::size_t end = text_.find('"', begin + 1);
            token_ = text_.substr(begin + 1, end == std::string::npos ? end : end - begin - 1);
            at_ = end == std::string::npos ? text_.size() : end + 1;
            if (end == std::string::npos) fail("expected a closing quote");
            return;
        }
        if (is([](int d) { return std::isdigit(d) || d == '.'; })) {
            kind_ = Kind::kNumber;
            const char* const last = text_.data() + text_.size();
            const auto [end, error] = std::from_chars(text_.data() + begin, last, number_);
            if (error != std::errc()) fail("expected a number");
            at_ = static_cast<std::size_t>(end - text_.data());
        } else if (is([](int d) { return std::isalpha(d) || d == '_'; })) {
            kind_ = Kind::kName;
            while (is([](int d) { return std::isalnum(d) || d == '_'; })) ++at_;
        } else {
            kind_ = Kind::kSign;
            const std::string two = text_.substr(at_, 2);
            at_ += two == "<=" || two == ">=" || two == "==" || two == "!=" ? 2 : 1;
        }
        token_ = text_.substr(begin, at_ - begin);
    }

    bool is(std::string_view word) const {
        return (kind_ == Kind::kName || kind_ == Kind::kSign) && token_ == word;
    }
    bool take(std::string_view word) {
        if (!is(word)) return false;
        next();
        return true;
    }
    void need(std::string_view word) {
        if (!take(word)) fail("expected " + std::string(word));
    }

    static Node pair(Node::Kind kind, std::string word, Node left, Node right) {
        return {.kind = kind, .word = std::move(word), .parts = {std::move(left), std::move(right)}};
    }

    Node either() {
        Node left = both();
        while (take("or")) left = pair(Node::Kind::kOr, "or", std::move(left), both());
        return left;
    }
    Node both() {
        Node left = negated();
        while (take("and")) left = pair(Node::Kind::kAnd, "and", std::move(left), negated());
        return left;
    }
    Node negated() {
        if (++depth_ > kDeepest) fail("expected fewer levels");
        Node node = [this] {
            if (!take("not")) return compared();
            return Node{.kind = Node::Kind::kNot, .word = "not", .parts = {negated()}};
        }();
        --depth_;
        return node;
    }
    Node compared() {
        // A ball named before `near` is not a measure.
        if (kind_ == Kind::kName || kind_ == Kind::kText || kind_ == Kind::kNumber) {
            const std::size_t here = at_;
            const auto kind = kind_;
            const std::string token = token_;
            const double number = number_;
            next();
            if (take("near")) return near(token);
            at_ = here;
            kind_ = kind;
            token_ = token;
            number_ = number;
        }
        Node left = sum();
        for (const char* word : {"==", "!=", "<=", ">=", "<", ">"}) {
            if (!is(word)) continue;
            next();
            Node right = sum();
            const bool order = word[0] == '<' || word[0] == '>';
            if (order && !(is_number(left) && is_number(right)))
                fail("expected numbers beside " + std::string(word));
            as_list(left, right);
            as_list(right, left);
            check_texts(left, right);
            check_texts(right, left);
            return pair(Node::Kind::kCompare, word, std::move(left), std::move(right));
        }
        if (take("in")) {
            Node right = sum();
            check_texts(left, right);
            return pair(Node::Kind::kIn, "in", std::move(left), std::move(right));
        }
        return left;
    }
    /// Rejects a text that the measure beside it never returns: the expression would never hold.
    void check_texts(const Node& text, const Node& measure) const {
        if (text.kind != Node::Kind::kValue || measure.kind != Node::Kind::kMeasure || is_number(measure))
            return;
        const auto known = known_texts(measure.row->info.name, scene_);
        if (!known) return;
        const std::string whole = text_of(text.value);
        for (std::size_t begin = 0; begin <= whole.size() && !whole.empty();) {
            const std::size_t end = std::min(whole.find(';', begin), whole.size());
            const std::string one = whole.substr(begin, end - begin);
            if (std::find(known->texts.begin(), known->texts.end(), one) == known->texts.end())
                throw MeasureError("\"" + text_ + "\": the scene has no " + known->what + " \"" + one + "\"");
            begin = end + 1;
        }
    }
    Node near(const std::string& ball) {
        Node place;
        place.kind = Node::Kind::kMeasure;
        place.row = row("distance");
        place.arguments.ball = index(ball);
        need("(");
        std::vector<double> numbers = {signed_number()};
        while (take(",")) numbers.push_back(signed_number());
        need(")");
        if (numbers.size() != 2 && numbers.size() != 3) fail("expected (X, Y) or (X, Y, METRES)");
        if (numbers.size() == 3 && !(numbers[2] >= 0.0))
            throw MeasureError("\"" + text_ +
                               "\": no ball is nearer than 0 m; expected METRES of at least 0");
        Node limit;
        limit.value = numbers.size() == 3 ? numbers[2] : kNear;
        place.arguments.numbers = {numbers[0], numbers[1]};
        return pair(Node::Kind::kCompare, "<=", std::move(place), std::move(limit));
    }
    Node sum() {
        Node left = product();
        while (is("+") || is("-")) {
            const std::string word = token_;
            next();
            left = arithmetic(word, std::move(left), product());
        }
        return left;
    }
    Node product() {
        Node left = single();
        while (is("*") || is("/")) {
            const std::string word = token_;
            next();
            left = arithmetic(word, std::move(left), single());
        }
        return left;
    }
    Node arithmetic(const std::string& word, Node left, Node right) const {
        if (!is_number(left) || !is_number(right)) fail("expected numbers beside " + word);
        return pair(Node::Kind::kSum, word, std::move(left), std::move(right));
    }
    Node single() {
        Node node;
        if (take("(")) {
            node = either();
            need(")");
            return node;
        }
        if (kind_ == Kind::kNumber || is("-")) {
            node.value = signed_number();
            return node;
        }
        if (kind_ == Kind::kText) {
            node.value = Texts{token_};
            next();
            return node;
        }
        if (kind_ != Kind::kName) fail("expected a measure, a number or a text in quotes");
        return measure();
    }
    double signed_number() {
        const bool minus = take("-");
        if (kind_ != Kind::kNumber) fail("expected a number");
        const double number = minus ? -number_ : number_;
        next();
        return number;
    }

    const MeasureRow* row(std::string_view name) const {
        for (const MeasureRow& row : measure_rows())
            if (name == row.info.name) return &row;
        return nullptr;
    }
    int index(const std::string& id) const {
        if (const int ball = index_of(scene_.ball, id); ball >= 0) return ball;
        fail("the scene has no ball \"" + id + "\"");
    }

    Node measure() {
        Node node;
        node.kind = Node::Kind::kMeasure;
        node.row = row(token_);
        if (node.row == nullptr)
            fail("expected a measure (see carom describe measures); put texts in quotes");
        const std::string_view expected = node.row->info.arguments;
        std::string how = node.row->info.name;
        how.append("(").append(expected).append(")");
        next();
        node.arguments.game = game_;
        std::vector<std::string> words;
        if (take("(")) {
            while (!is(")")) {
                const bool minus = take("-");
                if (kind_ == Kind::kEnd || kind_ == Kind::kSign) fail("expected " + how);
                if (minus) token_.insert(0, 1, '-');
                words.push_back(token_);
                next();
                if (!is(")")) need(",");
            }
            next();
        }
        std::size_t given = 0;
        for (std::string_view rest = expected; !rest.empty();) {
            const std::size_t end = rest.find(", ");
            const std::string_view what = rest.substr(0, end);
            rest = end == rest.npos ? "" : rest.substr(end + 2);
            if (given == words.size()) {
                if (what == "GAME" && game_) continue;
                fail("expected " + how);
            }
            argument(node.arguments, what, words[given++]);
        }
        if (given != words.size()) fail("expected " + how);
        return node;
    }
    void argument(Arguments& to, std::string_view what, const std::string& word) const {
        if (what == "BALL") {
            to.ball = index(word);
        } else if (what == "GAME") {
            to.game = game_of(word);
        } else {
            const auto number = as_number<double>(word);
            if (!number) fail("expected a number in place of \"" + word + "\"");
            if (what == "K" && !(*number >= 1.0 && *number <= 1000.0))
                fail("expected a number from 1 to 1000");
            to.numbers.push_back(*number);
        }
    }
    Game game_of(const std::string& word) const {
        try {
            return game_named(word);
        } catch (const std::invalid_argument& refused) {
            fail(refused.what());
        }
    }

    // [levels] Deeper ones could overflow the stack.
    static constexpr int kDeepest = 100;
    const std::string& text_;
    const Scene& scene_;
    std::optional<Game> game_;
    std::size_t at_ = 0;
    Kind kind_ = Kind::kEnd;
    std::string token_;
    double number_ = 0.0;
    int depth_ = 0;
};

}  // namespace

bool is_number(const Node& node) {
    if (node.kind == Node::Kind::kValue) return std::holds_alternative<double>(node.value);
    if (node.kind != Node::Kind::kMeasure) return true;
    const std::string_view unit = node.row->info.unit;
    return unit != "text" && unit != "list";
}

Measure::Node read_tree(const std::string& text, const Scene& scene, std::optional<Game> game) {
    return MeasureReader(text, scene, game).whole();
}

}  // namespace carom::games::detail
