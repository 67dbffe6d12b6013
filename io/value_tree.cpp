#include "io/value_tree.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include <fmt/format.h>

namespace abbe {
namespace {

std::string escaped(std::string_view key) {
  std::string token;
  for (const char c : key) {
    if (c == '~')
      token += "~0";
    else if (c == '/')
      token += "~1";
    else
      token += c;
  }
  return token;
}

}  // namespace

ValueTree::ValueTree(std::shared_ptr<const SourceText> source, std::string pointer, ErrorCode code,
                     Diagnostics& diagnostics, MemoryReservation* memory)
    : source_(std::move(source)),
      pointer_(std::move(pointer)),
      code_(code),
      diagnostics_(diagnostics),
      memory_(memory) {}

void ValueTree::key(std::string name, std::size_t offset) {
  key_ = std::move(name);
  key_offset_ = offset;
}

bool ValueTree::add(decltype(JsonValue::value) value, std::size_t offset) {
  std::string pointer = next_pointer();
  if (pointer.size() > kMaxPointer)
    return refuse(
        offset,
        fmt::format("keys too long (got a path of {} bytes, allowed {})", pointer.size(), kMaxPointer),
        this->pointer());
  if (memory_ != nullptr) count(value, pointer);
  last_ = insert({std::move(value), {source_, offset, std::move(pointer)}});
  return true;
}

// The factor 2 allows for the spare capacity of growing lists.
void ValueTree::count(const decltype(JsonValue::value)& value, const std::string& pointer) {
  const bool in_object = !open_.empty() && std::holds_alternative<JsonValue::Object>(open_.back()->value);
  const auto* text = std::get_if<std::string>(&value);
  memory_->reserve(source_->file, 2 * (in_object ? sizeof(JsonValue::Member) : sizeof(JsonValue)) +
                                      pointer.size() + key_.size() + (text != nullptr ? text->size() : 0));
}

bool ValueTree::open(decltype(JsonValue::value) container, std::size_t offset) {
  if (open_.size() == kMaxDepth)
    return refuse(offset, fmt::format("nesting too deep (allowed {} levels)", kMaxDepth), "");
  if (!add(std::move(container), offset)) return false;
  open_.push_back(last_);
  return true;
}

void ValueTree::close() {
  if (const auto* object = std::get_if<JsonValue::Object>(&open_.back()->value)) report_duplicates(*object);
  open_.pop_back();
}

void ValueTree::report_duplicates(const JsonValue::Object& object) {
  if (object.size() < 2) return;
  std::vector<const JsonValue::Member*> members;
  members.reserve(object.size());
  for (const auto& member : object) members.push_back(&member);
  std::sort(members.begin(), members.end(),
            [](auto* a, auto* b) { return std::tie(a->first, a) < std::tie(b->first, b); });
  for (std::size_t i = 1; i < members.size(); ++i)
    if (members[i]->first == members[i - 1]->first)
      refuse(members[i]->second.key_offset, fmt::format("duplicate key \"{}\"", members[i]->first),
             members[i]->second.where.pointer);
}

bool ValueTree::refuse(std::size_t offset, std::string message, std::string pointer) {
  diagnostics_.error({source_, offset, std::move(pointer)}, std::move(message), code_);
  refused_ = true;
  return false;
}

bool ValueTree::refuse(std::size_t offset, std::string message) {
  return refuse(offset, std::move(message), next_pointer());
}

std::string ValueTree::pointer() const {
  return open_.empty() ? pointer_ : open_.back()->where.pointer;
}

std::string ValueTree::next_pointer() const {
  if (open_.empty()) return pointer_;
  const JsonValue& parent = *open_.back();
  const auto* array = std::get_if<JsonValue::Array>(&parent.value);
  const std::string token = array ? std::to_string(array->size()) : escaped(key_);
  std::string pointer;
  pointer.reserve(parent.where.pointer.size() + 1 + token.size());
  return pointer.append(parent.where.pointer).append("/").append(token);
}

// The returned pointer stays valid while the value is open: its parent grows again only after it has been
// closed.
JsonValue* ValueTree::insert(JsonValue value) {
  if (open_.empty()) return &(root_ = std::move(value));
  JsonValue& parent = *open_.back();
  if (auto* array = std::get_if<JsonValue::Array>(&parent.value))
    return &array->emplace_back(std::move(value));
  value.key_offset = key_offset_;
  auto& object = std::get<JsonValue::Object>(parent.value);
  object.push_back({std::move(key_), std::move(value)});
  return &object.back().second;
}

}  // namespace abbe
