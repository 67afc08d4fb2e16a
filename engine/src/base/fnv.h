// The 64-bit FNV-1a hash, for hashes that users see and compare.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace carom {

class Fnv {
  public:
    void add(double x) { add_bytes(&x, sizeof x); }
    void add(std::uint64_t x) { add_bytes(&x, sizeof x); }
    void add(std::string_view text) { add_bytes(text.data(), text.size()); }
    /// A long text, eight bytes at a time: a different hash from add(), five times as fast.
    void add_long(std::string_view text) {
        for (; text.size() >= sizeof hash_; text.remove_prefix(sizeof hash_)) {
            std::uint64_t word = 0;
            std::memcpy(&word, text.data(), sizeof word);
            hash_ = (hash_ ^ word) * kPrime;
            hash_ ^= hash_ >> 32;
        }
        add(text);
    }
    std::uint64_t value() const { return hash_; }

  private:
    void add_bytes(const void* data, std::size_t size) {
        const auto* bytes = static_cast<const unsigned char*>(data);
        for (std::size_t i = 0; i < size; ++i) hash_ = (hash_ ^ bytes[i]) * kPrime;
    }
    static constexpr std::uint64_t kPrime = 0x100000001B3ull;
    std::uint64_t hash_ = 0xCBF29CE484222325ull;
};

}  // namespace carom
