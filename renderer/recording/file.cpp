#include "recording/file.h"

#include <fmt/format.h>

#include <bit>
#include <cstddef>
#include <cstring>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "base/json_text.h"

namespace lucerna::recording {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr char k_magic[] = "LUCPATHS", k_chunk[] = "CHNK", k_tree[] = "TREE", k_done[] = "DONE";
constexpr uint32_t k_version = 2;
constexpr uint64_t k_most_header = 64u << 20;

using Json = nlohmann::ordered_json;

struct ChunkHead {
  char tag[4];
  uint32_t paths;
  uint64_t events;
  uint64_t hash;
};
struct TreeHead {
  char tag[4];
  uint32_t leaves;
  uint64_t rows;
  double light;
  uint64_t hash;
};
static_assert(sizeof(ChunkHead) == 24 && sizeof(TreeHead) == 32 && sizeof(Path) == 20 && sizeof(Box) == 24 &&
              sizeof(PlaceIndex::Row) == 8);

template <class T>
std::string_view bytes_of(const T& value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}
template <class T>
std::string_view bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

uint64_t hash_of(const Recording& part) {
  return checksum(bytes_of(part.events), checksum(bytes_of(part.paths)));
}
uint64_t hash_of(TreeHead head, const PlaceIndex& index) {
  head.hash = 0;
  return checksum(bytes_of(index.rows),
                  checksum(bytes_of(index.leaves), checksum(bytes_of(index.hash), checksum(bytes_of(head)))));
}
/// Of an end: there is nothing behind its head.
uint64_t hash_of_end(uint64_t paths, uint64_t events) {
  return checksum(bytes_of(events), checksum(bytes_of(paths)));
}

Json field(const char* name, const char* type, int count, size_t offset) {
  return {{"name", name}, {"type", type}, {"count", count}, {"offset", offset}};
}

Json schema() {
  const auto word = [](const char* name, size_t offset) { return field(name, "uint32", 1, offset); };
  const auto triple = [](const char* name, size_t offset) { return field(name, "float32", 3, offset); };
  Json path, event;
  path["bytes"] = sizeof(Path);
  path["fields"] = {word("pixel", offsetof(Path, pixel)), word("sample", offsetof(Path, sample)),
                    word("first", offsetof(Path, first)), word("count", offsetof(Path, count)),
                    word("lost", offsetof(Path, lost))};
  event["bytes"] = sizeof(Event);
  event["fields"] = {triple("position", offsetof(Event, position)),
                     field("pdf", "float32", 1, offsetof(Event, pdf)),
                     triple("normal", offsetof(Event, normal)),
                     word("parent", offsetof(Event, parent)),
                     triple("throughput", offsetof(Event, throughput)),
                     word("bits", offsetof(Event, bits)),
                     triple("contribution", offsetof(Event, contribution)),
                     word("served", offsetof(Event, served)),
                     word("primitive", offsetof(Event, primitive)),
                     word("material", offsetof(Event, material)),
                     word("light", offsetof(Event, light)),
                     word("record", offsetof(Event, record))};
  Json bits;
  bits["kind"] = {0, 8}, bits["lobe"] = {8, 4}, bits["reason"] = {12, 4}, bits["component"] = {16, 4},
  bits["group"] = {20, 8};
  event["bits"] = bits;
  event["kinds"] = k_kind_names;
  event["reasons"] = k_reason_names;
  event["lobes"] = {"D", "G", "S"};
  event["components"] = paths::k_component_names;
  return {{"path", path}, {"event", event}};
}

}  // namespace

Writer::Writer(const std::filesystem::path& file, const Recording& names, const Json& about) : out_(file) {
  Json header;
  header["program"] = "lucerna " LUCERNA_VERSION;
  header["scene"] = names.scene;
  header["width"] = names.width, header["height"] = names.height, header["seed"] = names.seed;
  for (const auto& [key, value] : about.items()) header[key] = value;
  header["materials"] = names.materials, header["lights"] = names.lights, header["groups"] = names.groups;
  if (names.times.measured())
    header["ray_us"] = {{"surface", names.times.surface}, {"light", names.times.light}};
  header["schema"] = schema();
  const std::string text = json_text(header, 1);
  const auto bytes = uint32_t(text.size());
  out_.write({k_magic, 8});
  out_.write(bytes_of(k_version));
  out_.write(bytes_of(bytes));
  out_.write(bytes_of(checksum(text)));
  out_.write(text);
}

void Writer::add(const Recording& part) {
  if (part.paths.empty()) return;
  ChunkHead head{};
  std::memcpy(head.tag, k_chunk, 4);
  head.paths = uint32_t(part.paths.size()), head.events = part.events.size(), head.hash = hash_of(part);
  out_.write(bytes_of(head));
  out_.write(bytes_of(part.paths));
  out_.write(bytes_of(part.events));
  const PlaceIndex index = make_place_index(part);
  TreeHead tree{};
  std::memcpy(tree.tag, k_tree, 4);
  tree.leaves = uint32_t(index.leaves.size()), tree.rows = index.rows.size(), tree.light = index.light;
  tree.hash = hash_of(tree, index);
  out_.write(bytes_of(tree));
  out_.write(bytes_of(index.hash));
  out_.write(bytes_of(index.leaves));
  out_.write(bytes_of(index.rows));
  paths_ += part.paths.size(), events_ += part.events.size();
}

void Writer::finish() {
  // The number of paths may exceed 32 bits: the end has both sums behind its head.
  ChunkHead head{};
  std::memcpy(head.tag, k_done, 4);
  head.hash = hash_of_end(paths_, events_);
  out_.write(bytes_of(head));
  out_.write(bytes_of(paths_));
  out_.write(bytes_of(events_));
  out_.commit();
}

void Reader::refuse(const std::string& what) const {
  throw Error(file_.string(), fmt::format("byte {}: {}", at_, what));
}

void Reader::read(void* to, uint64_t bytes, const char* what) {
  if (bytes > size_ - at_) refuse(fmt::format("the file ends within {}: it was cut", what));
  in_.read(static_cast<char*>(to), std::streamsize(bytes));
  if (!in_) refuse(fmt::format("{} cannot be read", what));
  at_ += bytes;
}

Reader::Reader(const std::filesystem::path& file) : file_(file) {
  std::error_code failed;
  if (std::filesystem::is_directory(file, failed))
    throw Error(file.string(), "is a folder; expected an .lpath file");
  // A pipe cannot be read back and forth, and may never answer.
  if (std::filesystem::exists(file, failed) && !is_plain_file(file))
    throw Error(file.string(), "is a pipe or a device; expected an .lpath file");
  in_.open(file, std::ios::binary);
  if (!in_) throw Error(file.string(), "cannot be opened");
  size_ = std::filesystem::file_size(file, failed);
  if (failed) throw Error(file.string(), "cannot be read: " + failed.message());
  char magic[8];
  if (size_ < sizeof magic) refuse("not a file of recorded paths (.lpath)");
  read(magic, sizeof magic, "its name");
  at_ = 0;
  if (std::memcmp(magic, k_magic, sizeof magic) != 0) refuse("not a file of recorded paths (.lpath)");
  at_ = sizeof magic;
  uint32_t version = 0, bytes = 0;
  uint64_t hash = 0;
  read(&version, sizeof version, "the version");
  if (version != k_version)
    refuse(fmt::format("version {} of the format; this program reads version {}", version, k_version));
  read(&bytes, sizeof bytes, "the header");
  read(&hash, sizeof hash, "the header");
  if (bytes > k_most_header) refuse(fmt::format("a header of {} bytes: damaged", bytes));
  std::string text(bytes, '\0');
  read(text.data(), bytes, "the header");
  if (checksum(text) != hash) refuse("the header is damaged: its checksum differs");
  try {
    header_ = Json::parse(text);
    if (header_.at("schema") != Json::parse(json_text(schema())))
      refuse("its events have other fields than this program's");
    names_.scene = header_.at("scene").get<std::string>();
    names_.width = header_.at("width").get<uint32_t>(), names_.height = header_.at("height").get<uint32_t>();
    names_.seed = header_.at("seed").get<uint32_t>();
    names_.materials = header_.at("materials").get<std::vector<std::string>>();
    names_.lights = header_.at("lights").get<std::vector<std::string>>();
    names_.groups = header_.at("groups").get<std::vector<std::string>>();
    if (const auto times = header_.find("ray_us"); times != header_.end())
      names_.times = {times->at("surface").get<double>(), times->at("light").get<double>()};
  } catch (const Json::exception& e) {
    refuse(fmt::format("the header cannot be read: {}", e.what()));
  }
  if (names_.width == 0 || names_.height == 0) refuse("the header names a picture without pixels");
}

void Reader::move_to(uint64_t at) {
  in_.seekg(std::streamoff(at));
  if (!in_) refuse("cannot be read");
  at_ = at;
}

PlaceIndex Reader::read_index(uint32_t paths) {
  const uint64_t begin = at_;
  TreeHead head{};
  read(&head, sizeof head, "an index");
  at_ = begin;
  if (std::memcmp(head.tag, k_tree, 4) != 0) refuse("expected the index of a chunk: damaged");
  at_ += sizeof head;
  const uint64_t left = size_ - at_;
  if (head.rows > left / sizeof(PlaceIndex::Row) ||
      head.leaves != (head.rows + PlaceIndex::k_leaf_rows - 1) / PlaceIndex::k_leaf_rows)
    refuse(fmt::format("an index of {} rows, but {} bytes are left: it was cut", head.rows, left));
  PlaceIndex index;
  index.hash.resize(paths), index.leaves.resize(head.leaves), index.rows.resize(head.rows);
  index.light = head.light;
  read(index.hash.data(), paths * sizeof(uint64_t), "an index");
  read(index.leaves.data(), head.leaves * sizeof(Box), "an index");
  read(index.rows.data(), head.rows * sizeof(PlaceIndex::Row), "an index");
  const uint64_t end = std::exchange(at_, begin);
  if (hash_of(head, index) != head.hash) refuse("the index of a chunk is damaged: its checksum differs");
  for (const PlaceIndex::Row& row : index.rows)
    if (row.path >= paths) refuse("an index names a path that its chunk does not have: damaged");
  at_ = end;
  rows_ += head.rows, light_ += head.light;
  return index;
}

void Reader::check(const Recording& chunk, const Path& path, uint64_t events) const {
  if (path.pixel >= uint64_t{chunk.width} * chunk.height || path.first > events ||
      path.count > events - path.first)
    refuse("a path lies outside the picture or its chunk: damaged");
}

void Reader::read_paths(const PlaceIndex& index, const std::vector<uint32_t>& which, uint64_t begin,
                        uint64_t events, Recording& into) {
  std::vector<Path> paths;
  for (const uint32_t i : which) {
    move_to(begin + i * sizeof(Path));
    read(&paths.emplace_back(), sizeof(Path), "a path");
    at_ -= sizeof(Path);
    check(into, paths.back(), events);
  }
  const uint64_t first_event = begin + index.hash.size() * sizeof(Path);
  for (size_t i = 0; i < which.size(); ++i) {
    Path path = paths[i];
    std::vector<Event> own(path.count);
    move_to(first_event + path.first * sizeof(Event));
    read(own.data(), own.size() * sizeof(Event), "a path");
    if (path_checksum(path, own) != index.hash[which[i]]) refuse("a path is damaged: its checksum differs");
    path.first = uint32_t(into.events.size());
    into.paths.push_back(path);
    into.events.insert(into.events.end(), own.begin(), own.end());
  }
}

std::optional<Recording> Reader::next(const std::optional<Box>& places) {
  const uint64_t begin = at_;
  ChunkHead head{};
  read(&head, sizeof head, "the head of a chunk");
  if (std::memcmp(head.tag, k_done, 4) == 0) {
    uint64_t paths = 0, events = 0;
    read(&paths, sizeof paths, "its end");
    read(&events, sizeof events, "its end");
    if (head.hash != hash_of_end(paths, events)) refuse("the end is damaged: its checksum differs");
    if (paths != paths_ || events != events_)
      refuse(fmt::format("{} paths were written, {} are there", paths, paths_));
    if (at_ != size_) refuse(fmt::format("{} bytes behind the end", size_ - at_));
    return std::nullopt;
  }
  at_ = begin;
  if (std::memcmp(head.tag, k_chunk, 4) != 0) refuse("expected a chunk: damaged");
  at_ += sizeof head;
  const uint64_t left = size_ - at_;
  if (head.events > left / sizeof(Event) || head.paths * sizeof(Path) + head.events * sizeof(Event) > left)
    refuse(fmt::format("a chunk of {} events, but {} bytes are left: it was cut", head.events, left));
  Recording chunk = names_;
  const uint64_t first = at_, end = at_ + head.paths * sizeof(Path) + head.events * sizeof(Event);
  if (places) {
    move_to(end);
    const PlaceIndex index = read_index(head.paths);
    const uint64_t after = at_;
    const std::vector<uint32_t> which = paths_in(index, *places);
    read_paths(index, which, first, head.events, chunk);
    move_to(after);
  } else {
    chunk.paths.resize(head.paths), chunk.events.resize(head.events);
    read(chunk.paths.data(), head.paths * sizeof(Path), "a chunk");
    read(chunk.events.data(), head.events * sizeof(Event), "a chunk");
    at_ = begin;
    if (hash_of(chunk) != head.hash) refuse("a chunk is damaged: its checksum differs");
    for (const Path& path : chunk.paths) check(chunk, path, head.events);
    at_ = end;
    read_index(head.paths);
  }
  paths_ += head.paths, events_ += head.events;
  return chunk;
}

}  // namespace lucerna::recording
