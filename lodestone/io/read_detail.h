// What all readers share: progress, places and sizes in messages, positions from doubles, and the common end.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/model.h"
#include "lodestone/io/byte_reader_detail.h"

namespace lodestone::io {

/// Share of a reader's task that goes to the file itself; the rest is welding.
inline constexpr double kReadingShare = 0.6;

/// Tells a task how far a reader has come in its file.
class ReadProgress {
 public:
  ReadProgress(Task task, std::uint64_t size) : task_(std::move(task)), size_(size) {}
  /// Call every some thousand records. False once the task is cancelled.
  bool go_on(std::uint64_t position);

 private:
  Task task_;
  std::uint64_t size_;
  std::uint64_t told_ = 0;
};

/// "file.ply:14" and "file.ply: byte 213"
std::string line_place(std::string_view name, std::uint64_t line);
std::string byte_place(std::string_view name, std::uint64_t byte);

/// "2^40" for large powers of two, "1,234,567" for others.
std::string count_text(std::uint64_t count);
/// "213 bytes", "12 TiB": what a number of records of some bytes needs; may be beyond 64 bits.
std::string size_text(double bytes);

/// The error of a count that the file cannot hold: "vertex count 2^40 needs 12 TiB, the file has 213 bytes; is it cut
/// off?"
tl::unexpected<Error> count_too_large(std::string_view what, std::uint64_t count, std::uint64_t bytes_each,
                                      std::uint64_t file_bytes, std::string place);

/// Where a file's doubles lie far from the origin, measured by their own size, 32-bit floats would spoil their shape:
/// this is then a round point near the centre of `box`, which the floats are to be relative to. Zero otherwise.
Vec3d offset_for(const Box3d& box);

/// Fills mesh.positions and mesh.offset. Coordinates beyond float become infinite, which finish_model() refuses.
void set_positions(Mesh& mesh, std::span<const Vec3d> positions);

/// How a reader ends. `model` holds one mesh and its file_* counts. Refuses a model without triangles (empty) and
/// triangles with corners that are not finite (bad_format, vertices counted from `first_vertex`); sets attribute values
/// that are not finite to zero (warning); welds and validates. `name` is the file's.
Result<Model> finish_model(Model model, std::string_view name, std::uint64_t first_vertex, Task task);

/// "1 face" / "3 faces"
std::string counted(std::uint64_t count, std::string_view singular, std::string_view plural);

}  // namespace lodestone::io
