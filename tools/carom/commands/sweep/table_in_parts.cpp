#include "commands/sweep/table_in_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "base/console.h"
#include "base/fnv.h"

namespace carom::tools {

namespace fs = std::filesystem;

namespace {

/// A kill loses at most the last interval. The first intervals are shorter; each is twice the previous one.
constexpr std::chrono::milliseconds kFirstWait(50), kLongestWait(1000);

std::string hash_line(std::string_view text) {
    Fnv hash;
    hash.add_long(text);
    return fmt::format("{:016x}\n", hash.value());
}

/// The folder of another sweep that is writing this table now, or "".
std::string other_sweep(const std::string& path, const std::string& own) {
    const fs::path table = file_of(path);
    const std::string start = table.filename().string() + ".";
    std::error_code error;
    const fs::path folder = table.has_parent_path() ? table.parent_path() : fs::path(".");
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
        const std::string name = entry.path().filename().string();
        if (!name.starts_with(start) || !name.ends_with(".parts") || name == fs::path(own).filename())
            continue;
        const std::string lock = (entry.path() / "lock").string();
        if (!fs::exists(lock, error)) continue;
        try {
            const FileLock free(lock, true);
        } catch (const std::exception&) {
            return entry.path().string();
        }
    }
    return "";
}

}  // namespace

TableInParts::TableInParts(const std::string& path, std::uint64_t id, std::string_view header,
                           std::uint64_t first, const std::function<void(std::string_view)>& found)
    : whole_(path), next_(first), kept_(first), wait_(kFirstWait) {
    whole_.write(header);
    if (whole_.is_direct()) return;
    const std::string folder = fmt::format("{}.{:016x}.parts", file_of(path), id);
    // Other users may be able to write beside the table and guess the name, so links are not followed.
    std::error_code error;
    const fs::file_status there = fs::symlink_status(folder, error);
    if (fs::exists(there) && !fs::is_directory(there))
        throw std::runtime_error(folder + ": this is not a folder; remove it");
    if (fs::create_directory(folder, error); error)
        throw std::runtime_error(folder + ": cannot make this folder: " + error.message());
    folder_ = folder;
    lock_.emplace(folder_ + "/lock", true);
    // Two sweeps that write one table would each assume that it contains their rows.
    if (const std::string other = other_sweep(path, folder_); !other.empty())
        throw std::runtime_error(
            fmt::format("{}: another sweep is writing this table (see {}); give each its own", path, other));
    while (take_up())
        if (found) found(found_);
}

TableInParts::~TableInParts() {
    if (writing_.valid()) writing_.wait();
    lock_.reset();
    std::error_code ignored;
    if (!folder_.empty()) fs::remove(folder_, ignored);  // unless it holds parts
}

std::string TableInParts::part(std::uint64_t first) const {
    return fmt::format("{}/{}.csv", folder_, first);
}

bool TableInParts::take_up() {
    const std::string path = part(next_);
    std::ifstream file(path, std::ios::binary);
    if (!file) return false;
    std::string text(std::istreambuf_iterator<char>(file), {});
    const std::size_t hash = text.size() - std::min(text.size(), hash_line("").size());
    const bool whole = text.substr(hash) == hash_line(std::string_view(text).substr(0, hash));
    const std::size_t about = hash < 2 ? 0 : text.rfind('\n', hash - 2) + 1;
    const nlohmann::json said =
        nlohmann::json::parse(text.begin() + static_cast<std::ptrdiff_t>(about),
                              text.begin() + static_cast<std::ptrdiff_t>(hash), nullptr, false);
    if (!whole || !said.is_object() || said.value("first", next_ + 1) != next_ ||
        said.value("last", next_) <= next_)
        throw std::runtime_error(
            path + ": its rows were changed after they were written; remove it and run the sweep again");
    if (const std::string version = said.value("version", ""); version != program_version())
        throw std::runtime_error(fmt::format(
            "{}: this is carom {}, and the part was written by carom {}; use that version, or remove {}",
            path, program_version(), version, folder_));
    found_ = text.substr(0, about);
    whole_.write(found_);
    next_ = kept_ = said.at("last");
    failed_ += said.value("failed", std::uint64_t{0});
    failed_kept_ = failed_;
    return true;
}

void TableInParts::add(std::string_view rows, std::uint64_t shots, std::uint64_t failed) {
    whole_.write(rows);
    next_ += shots;
    failed_ += failed;
    if (folder_.empty()) return;
    rows_ += rows;
    if (Clock::now() - kept_at_ < wait_) return;
    begin_part();
    wait_ = std::min<Clock::duration>(2 * wait_, kLongestWait);
}

void TableInParts::keep() {
    begin_part();
    if (writing_.valid()) writing_.get();
}

// Another thread writes the part, because one that writes all rows twice limits how many others can play.
void TableInParts::begin_part() {
    if (rows_.empty()) return;
    const nlohmann::ordered_json about = {{"version", program_version()},
                                          {"first", kept_},
                                          {"last", next_},
                                          {"failed", failed_ - failed_kept_}};
    rows_ += about.dump() + '\n';
    if (writing_.valid()) writing_.get();
    writing_ = std::async(std::launch::async, [path = part(kept_), text = std::exchange(rows_, {})] {
        OutputFile file(path);
        file.write(text);
        file.write(hash_line(text));
        file.commit(true);
    });
    kept_ = next_;
    failed_kept_ = failed_;
    kept_at_ = Clock::now();
}

void TableInParts::commit() {
    if (writing_.valid()) writing_.get();
    whole_.commit(true);
    std::error_code ignored;
    if (!folder_.empty()) fs::remove_all(folder_, ignored);
}

}  // namespace carom::tools
