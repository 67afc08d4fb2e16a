// Keys with thousands of parts and deeply nested brackets are refused before they overflow even a small
// stack; nothing else is refused.
#include <gtest/gtest.h>
#include <pthread.h>

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "carom/engine/tolerances.h"
#include "scene/distribution.h"
#include "scene/reader.h"
#include "support/scene_errors.h"

namespace carom::test {
namespace {

/// "a.a.a"
std::string dotted(int parts, const std::string& part = "a") {
    std::string key = part;
    for (int i = 1; i < parts; ++i) key += "." + part;
    return key;
}

/// Every place where TOML accepts a dotted key.
std::vector<std::string> all_places(const std::string& key) {
    return {key + " = 1\n",
            "[" + key + "]\n",
            "[[" + key + "]]\n",
            "x = {" + key + " = 1}\n",
            "x = [{y = 2, " + key + " = 1}]\n",
            "[[ball]]\n[cue]\nspeed = 1 # .\n" + key + " = 1\n"};
}

void in_small_thread(const std::function<void()>& work) {
    pthread_attr_t attributes;
    pthread_t thread;
    ASSERT_EQ(pthread_attr_init(&attributes), 0);
    ASSERT_EQ(pthread_attr_setstacksize(&attributes, 512 << 10), 0);
    const auto run = [](void* argument) -> void* {
        (*static_cast<const std::function<void()>*>(argument))();
        return nullptr;
    };
    ASSERT_EQ(pthread_create(&thread, &attributes, run, const_cast<std::function<void()>*>(&work)), 0);
    pthread_join(thread, nullptr);
    pthread_attr_destroy(&attributes);
}

TEST(SceneDepth, AKeyOfManyPartsIsRefusedAnywhere) {
    const std::string want = "this key has more than 16 parts";
    for (const int parts : {kMaxKeyParts + 1, 2000, 40000, 300000}) {
        const std::vector<std::string> keys = {dotted(parts), dotted(parts, "\"a\""), dotted(parts, "'.'"),
                                               dotted(parts, " a\t")};
        for (const std::string& key : keys) {
            for (const std::string& text : all_places(key))
                EXPECT_NE(error_of(text).find(want), std::string::npos) << text.substr(0, 200);
        }
    }
    // A key that is only wrong causes no message about parts.
    for (const std::string& text : all_places(dotted(kMaxKeyParts))) {
        EXPECT_EQ(error_of(text).find("parts"), std::string::npos) << error_of(text);
        EXPECT_NE(error_of(text), "");
    }
}

TEST(SceneDepth, TheMessageNamesThePlace) {
    EXPECT_EQ(error_of("[cue]\n  " + dotted(40) + " = 1\n"),
              "s.toml:2:34: this key has more than 16 parts; remove some dots");
    // Columns count characters, not bytes, like those of toml++.
    EXPECT_EQ(error_of("x = [\"\u00e4\u00f6\", " + std::string(40, '[')).substr(0, 14), "s.toml:1:27: b");
    EXPECT_EQ(error_of("x = " + std::string(40, '[')),
              "s.toml:1:21: brackets are nested more than 16 deep here; close some above, or nest fewer");
}

TEST(SceneDepth, NestedValuesAreRefused) {
    for (const int deep : {kMaxNesting + 1, 255, 256, 257, 3000, 300000}) {
        std::string tables, lines;
        for (int i = 0; i < deep; ++i) {
            tables += "{a = ";
            lines += "[1, # [\n";
        }
        for (const std::string& open : {std::string(static_cast<std::size_t>(deep), '['), tables, lines})
            EXPECT_NE(error_of("x = " + open).find("brackets are nested more than 16 deep"),
                      std::string::npos);
    }
}

// Reaching both limits at once uses the most stack.
TEST(SceneDepth, SmallStacksAreEnough) {
    const auto nested = [](int parts, int deep) {
        const std::string key = dotted(parts);
        std::string text = "[" + key + "]\n" + key + " = ", close;
        for (int i = 0; i < deep; ++i) {
            text += "{" + key + " = ";
            close += "}";
        }
        return text + "1" + close + "\n";
    };
    std::vector<std::string> errors;
    in_small_thread([&] {
        for (const std::string& text : all_places(dotted(2000))) errors.push_back(error_of(text));
        errors.push_back(error_of(nested(kMaxKeyParts, kMaxNesting)));
        errors.push_back(error_of(nested(kMaxKeyParts, kMaxNesting + 1)));
        errors.push_back(error_of(nested(kMaxKeyParts + 1, 1)));
    });
    ASSERT_EQ(errors.size(), 9u);
    for (int i = 0; i < 6; ++i) EXPECT_NE(errors[i].find("parts"), std::string::npos);
    EXPECT_NE(errors[6].find("unknown section or key \"a\""), std::string::npos) << errors[6];
    EXPECT_NE(errors[7].find("brackets"), std::string::npos) << errors[7];
    EXPECT_NE(errors[8].find("parts"), std::string::npos) << errors[8];
}

// One for every reason why dots and brackets may be neither parts nor depth.
TEST(SceneDepth, OtherDotsAndBracketsAreAllowed) {
    const std::string dots(100, '.'), open(100, '['), numbers = dotted(400, "5, 0");
    const std::string texts[] = {
        "# " + dots + open + "\n",
        "x = 1 # \" ''' " + dots + open + "\ny = \"" + dots + "\"\n",
        "x = \"" + dots + open + "\"\n",
        "x = '" + dots + open + "'\n",
        "x = '" + open + "\\' # '\ny = \"" + dots + "\"\n",      // no escapes in a literal string
        "x = \"\\\"" + dots + open + "\\\\\" # " + dots + "\n",  // escaped quotation mark and backslash
        "x = \"\"\"\n" + dots + "\n\"\" \\\"\"\"" + open + "\"\"\"\n",  // two marks, and an escaped one
        "x = \"\"\"" + dots + "\"\"\"\"\"\ny = '" + dots + "'\n",       // two marks before the closing ones
        "x = '''\n" + dots + "\n'' " + open + "''''\ny = \"" + dots + "\"\n",
        "x = [\"\", '', \"\"\"\"\"\", '''''', \"" + dots + "\"]\n",  // empty strings
        "x = ['\"', \"'\", '" + open + "']\n",
        "\"" + dots + "\".'" + dots + "' = 1\n",
        "x = [" + numbers + "]\n",
        "x = [\n" + dotted(400, "5\n, 0") + "\n]\n",
        "x = {a = 1.5, b = 2.5, c = [0.5, 0.5]}\n",
        "x = 1979-05-27T07:32:00.999999Z\n",
        dotted(kMaxKeyParts) + " = 1\n" + dotted(kMaxKeyParts, "b") + " = 1\n",
    };
    for (const std::string& text : texts) {
        const auto deep = detail::too_deep(text);
        EXPECT_FALSE(deep) << text << "\n" << (deep ? deep->what : "");
        // Valid TOML, except that the keys are unknown.
        if (text[0] != '#') {
            EXPECT_NE(error_of(text).find("unknown section or key"), std::string::npos) << text << "\n"
                                                                                        << error_of(text);
        }
    }
    std::string lists = "x = [";
    for (int i = 0; i < 1000; ++i) lists += "[1], {a = [2]},\n";
    EXPECT_FALSE(detail::too_deep(lists + "]\n"));
    EXPECT_TRUE(detail::too_deep(lists + std::string(kMaxNesting, '[')));
}

// toml++ describes their error better.
TEST(SceneDepth, UnclosedSectionsAreNotCounted) {
    std::string text;
    for (int i = 0; i < 100; ++i) text += "[table\n[[ball\n";
    EXPECT_NE(error_of(text).find("s.toml:1:7: not valid TOML"), std::string::npos) << error_of(text);
}

TEST(SceneDepth, VaryingValuesHaveTheSameLimits) {
    std::vector<std::string> errors;
    in_small_thread([&] {
        for (const std::string& values :
             {"{" + dotted(40000) + " = 1}", "1]\n" + dotted(40000) + " = [2", std::string(40000, '[')}) {
            try {
                detail::parse_distribution("list(" + values + ")", nullptr);
            } catch (const std::invalid_argument& error) {
                errors.push_back(error.what());
            }
        }
    });
    ASSERT_EQ(errors.size(), 3u);
    EXPECT_EQ(errors[0].rfind("values of list: this key has more than 16 parts", 0), 0u) << errors[0];
    EXPECT_EQ(errors[1].rfind("values of list: this key has more than 16 parts", 0), 0u) << errors[1];
    EXPECT_EQ(errors[2].rfind("values of list: brackets are nested more than 16 deep", 0), 0u) << errors[2];
}

}  // namespace
}  // namespace carom::test
