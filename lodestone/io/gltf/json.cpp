// JSON in, without recursion and in linear time whatever the text is; and access that never throws.
#include <fmt/format.h>

#include <cmath>

#include "lodestone/io/gltf/gltf_detail.h"

namespace lodestone::io {

namespace {

constexpr std::size_t kMaxNesting = 200;  // copying and printing recurse
constexpr double kMaxWhole = 9007199254740992.0;

// Builds the value bottom-up. The library's own builder looks each key up in the object so far, which is quadratic.
class Builder : public nlohmann::json_sax<Json> {
 public:
  Json result;
  std::string error;
  std::size_t error_byte = 0;

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t&) override { return add(value); }
  bool string(string_t& value) override { return add(std::move(value)); }
  bool binary(binary_t&) override { return false; }
  bool key(string_t& value) override {
    frames_.back().key = std::move(value);
    return true;
  }
  bool start_object(std::size_t) override { return open(true); }
  bool end_object() override {
    Frame frame = std::move(frames_.back());
    frames_.pop_back();
    Json value = Json::object();
    Json::object_t& object = value.get_ref<Json::object_t&>();
    object.reserve(frame.keys.size());
    for (std::size_t i = 0; i < frame.keys.size(); ++i) {
      static_cast<Json::object_t::Container&>(object).emplace_back(std::move(frame.keys[i]),
                                                                   std::move(frame.values[i]));
    }
    return add(std::move(value));
  }
  bool start_array(std::size_t) override { return open(false); }
  bool end_array() override {
    Json value = Json::array();
    value.get_ref<Json::array_t&>() = std::move(frames_.back().values);
    frames_.pop_back();
    return add(std::move(value));
  }
  bool parse_error(std::size_t position, const std::string&, const Json::exception& problem) override {
    error_byte = position;
    error = problem.what();
    // "[json.exception.parse_error.101] parse error at line 1, column 5: syntax error ...": the last part is for
    // people.
    const std::size_t colon = error.find(": ");
    if (colon != std::string::npos) error.erase(0, colon + 2);
    return false;
  }

 private:
  struct Frame {
    bool is_object;
    std::string key;
    std::vector<std::string> keys;
    Json::array_t values;
  };
  std::vector<Frame> frames_;

  bool open(bool is_object) {
    if (frames_.size() >= kMaxNesting) {
      error = fmt::format("JSON nested more than {} deep", kMaxNesting);
      return false;
    }
    frames_.push_back(Frame{is_object, {}, {}, {}});
    return true;
  }

  bool add(Json value) {
    if (frames_.empty()) {
      result = std::move(value);
      return true;
    }
    Frame& frame = frames_.back();
    if (frame.is_object) frame.keys.push_back(std::move(frame.key));
    frame.values.push_back(std::move(value));
    return true;
  }
};

const Json kEmptyArray = Json::array();

std::string short_text(const Json& value) {
  std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (text.size() > 40) text = text.substr(0, 40) + "...";
  return text;
}

}  // namespace

Result<Json> parse_json(std::string_view text, const std::string& where) {
  Builder builder;
  const bool good = Json::sax_parse(text.begin(), text.end(), &builder);
  if (!good) {
    const std::string at = builder.error_byte > 0 ? fmt::format("{}: JSON byte {}", where, builder.error_byte) : where;
    return fail(ErrorCode::bad_format, builder.error.empty() ? "not JSON" : builder.error, at,
                "is the file cut off or not glTF?");
  }
  return std::move(builder.result);
}

const Json* member(const Json& object, std::string_view key) {
  if (!object.is_object()) return nullptr;
  for (const auto& [name, value] : object.get_ref<const Json::object_t&>()) {
    if (name == key) return &value;
  }
  return nullptr;
}

const Json& array_member(const Json& object, std::string_view key) {
  const Json* value = member(object, key);
  return value != nullptr && value->is_array() ? *value : kEmptyArray;
}

std::string string_member(const Json& object, std::string_view key) {
  const Json* value = member(object, key);
  return value != nullptr && value->is_string() ? value->get_ref<const std::string&>() : std::string();
}

bool lists(const Json& root, std::string_view key, std::string_view value) {
  for (const Json& entry : array_member(root, key)) {
    if (entry.is_string() && entry.get_ref<const std::string&>() == value) return true;
  }
  return false;
}

std::optional<std::uint64_t> as_uint(const Json& value) {
  if (value.is_number_unsigned()) {
    const auto number = value.get<std::uint64_t>();
    if (number <= static_cast<std::uint64_t>(kMaxWhole)) return number;
  } else if (value.is_number_integer()) {
    const auto number = value.get<std::int64_t>();
    if (number >= 0) return static_cast<std::uint64_t>(number);
  } else if (value.is_number_float()) {
    const double number = value.get<double>();
    if (number >= 0 && number <= kMaxWhole && std::floor(number) == number) return static_cast<std::uint64_t>(number);
  }
  return std::nullopt;
}

Result<std::uint64_t> uint_member(const Json& object, std::string_view key, std::uint64_t fallback,
                                  const std::string& where) {
  const Json* value = member(object, key);
  if (value == nullptr) return fallback;
  const std::optional<std::uint64_t> number = as_uint(*value);
  if (!number) {
    return fail(ErrorCode::bad_format,
                fmt::format("{} is {}, not a whole number from 0 to 2^53", key, short_text(*value)), where);
  }
  return *number;
}

Result<std::size_t> index_member(const Json& object, std::string_view key, std::size_t limit, const char* of,
                                 const std::string& where) {
  const Json* value = member(object, key);
  if (value == nullptr) return fail(ErrorCode::bad_format, fmt::format("{} is missing", key), where);
  const std::optional<std::uint64_t> number = as_uint(*value);
  if (!number || *number >= limit) {
    return fail(ErrorCode::bad_format, fmt::format("{} is {}, the file has {} {}", key, short_text(*value), limit, of),
                where);
  }
  return static_cast<std::size_t>(*number);
}

Result<bool> numbers_member(const Json& object, std::string_view key, std::span<double> into,
                            const std::string& where) {
  const Json* value = member(object, key);
  if (value == nullptr) return false;
  const auto wrong = [&] {
    return fail(ErrorCode::bad_format, fmt::format("{} is {}, not {} numbers", key, short_text(*value), into.size()),
                where);
  };
  if (!value->is_array() || value->size() != into.size()) return wrong();
  for (std::size_t i = 0; i < into.size(); ++i) {
    const Json& number = (*value)[i];
    if (!number.is_number()) return wrong();
    into[i] = number.get<double>();
  }
  return true;
}

}  // namespace lodestone::io
