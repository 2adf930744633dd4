// What every peer program does around the one call that is timed:
//   PROGRAM METHOD MESH TARGET_TRIANGLES OUT.ply REPEATS
// reads and welds MESH with our reader, calls the simplifier REPEATS times, writes the last result and prints the
// fastest time in seconds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace peers {

/// Vertices as three floats each, triangles as three indices each.
struct Triangles {
  std::vector<float> positions;
  std::vector<std::uint32_t> indices;
  std::size_t triangles() const { return indices.size() / 3; }
  std::size_t vertices() const { return positions.size() / 3; }
};

/// Simplifies `in` to `target` triangles and tells the seconds of the simplification alone, without conversions.
using Method = std::function<Triangles(const Triangles& in, std::size_t target, double& seconds)>;

struct NamedMethod {
  std::string name;
  Method run;
};

/// The whole program. Returns what main returns: 0, or 1 with a line on standard error.
int run(int argc, char** argv, const std::vector<NamedMethod>& methods);

/// Seconds that a call takes.
template <class Call>
double seconds_of(Call call);

double now_seconds();

/// Tells valgrind --tool=callgrind --instr-atstart=no where to count; does nothing outside it.
void count_instructions(bool on);

template <class Call>
double seconds_of(Call call) {
  count_instructions(true);
  const double begin = now_seconds();
  call();
  const double seconds = now_seconds() - begin;
  count_instructions(false);
  return seconds;
}

}  // namespace peers
