// Result<T>: a value or an Error that a person can act on. Nothing a user or a file can cause is an exception.
#pragma once

#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>

namespace lodestone {

/// What went wrong, coarse enough to decide on.
enum class ErrorCode {
  cannot_read,    ///< the input cannot be opened or read
  bad_format,     ///< the input is not what its format says
  unsupported,    ///< legal, but not built in or not done by us
  empty,          ///< the input holds nothing to work on
  bad_argument,   ///< an option or a combination of options makes no sense
  cannot_write,   ///< the output cannot be created, written or renamed
  out_of_memory,  ///< more memory needed than there is
  cancelled,      ///< the Task was cancelled
};

/// An error is one line: "where: what; remedy".
struct Error {
  ErrorCode code = ErrorCode::bad_argument;
  std::string what;    ///< what is wrong, with the value seen and the limit
  std::string where;   ///< file, file:line, file:byte offset or operation; may be empty
  std::string remedy;  ///< what the user can do; may be empty

  /// The whole error as one line without control characters.
  std::string line() const;
};

template <class T>
using Result = tl::expected<T, Error>;

/// `return fail(ErrorCode::bad_format, "face names vertex 9, the file has 8", "a.ply:14");`
inline tl::unexpected<Error> fail(ErrorCode code, std::string what, std::string where = {}, std::string remedy = {}) {
  return tl::unexpected<Error>(Error{code, std::move(what), std::move(where), std::move(remedy)});
}

/// Hands an error on.
inline tl::unexpected<Error> fail(Error error) { return tl::unexpected<Error>(std::move(error)); }

/// Leaves the function with the error of a Result, if it is one: `LODESTONE_TRY(validate(mesh));`, or
/// `const Result<Mesh> mesh = read(path);` and then `LODESTONE_TRY(mesh);`. The function returns a Result of any type.
#define LODESTONE_TRY(...)                                                                  \
  do {                                                                                      \
    if (const auto& tried = (__VA_ARGS__); !tried) return ::lodestone::fail(tried.error()); \
  } while (false)

/// The error of a cancelled Task; `operation` says what was stopped.
inline tl::unexpected<Error> cancelled_error(std::string_view operation) {
  return fail(ErrorCode::cancelled, "cancelled", std::string(operation));
}

}  // namespace lodestone
