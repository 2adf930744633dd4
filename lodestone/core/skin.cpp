#include "lodestone/core/skin.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace lodestone {

namespace {

template <class Stream>
struct Set {
  Stream *joints, *weights;
};
template <class Stream>
using Sets = std::vector<Set<Stream>>;

// JOINTS_n with WEIGHTS_n, in order. Stream is AttributeStream, const or not.
template <class Stream, class Streams>
Sets<Stream> sets_of(Streams& streams) {
  Sets<Stream> sets;
  for (Stream& j : streams) {
    if (j.semantic != Semantic::joints || !std::holds_alternative<std::vector<std::uint32_t>>(j.values)) continue;
    for (Stream& w : streams) {
      const bool pair = w.semantic == Semantic::weights && w.set == j.set && w.components == j.components &&
                        std::holds_alternative<std::vector<float>>(w.values);
      if (pair) sets.push_back({&j, &w});
    }
  }
  std::sort(sets.begin(), sets.end(), [](const auto& a, const auto& b) { return a.joints->set < b.joints->set; });
  return sets;
}

using Influences = std::vector<std::pair<std::uint32_t, float>>;  // joint, weight

template <class Stream>
void gather(const Sets<Stream>& sets, std::size_t wedge, Influences& out) {
  out.clear();
  for (const auto& set : sets) {
    const std::size_t n = set.joints->components;
    const auto& joints = std::get<std::vector<std::uint32_t>>(set.joints->values);
    const auto& weights = std::get<std::vector<float>>(set.weights->values);
    for (std::size_t k = 0; k < n; ++k) {
      if (weights[wedge * n + k] > 0) out.emplace_back(joints[wedge * n + k], weights[wedge * n + k]);
    }
  }
}

void put(const Sets<AttributeStream>& sets, std::size_t wedge, const Influences& in) {
  std::size_t next = 0;
  for (const auto& set : sets) {
    const std::size_t n = set.joints->components;
    auto& joints = std::get<std::vector<std::uint32_t>>(set.joints->values);
    auto& weights = std::get<std::vector<float>>(set.weights->values);
    for (std::size_t k = 0; k < n; ++k, ++next) {
      joints[wedge * n + k] = next < in.size() ? in[next].first : 0;
      weights[wedge * n + k] = next < in.size() ? in[next].second : 0;
    }
  }
}

}  // namespace

std::size_t wedges_above(const Mesh& mesh, std::size_t most) {
  const auto sets = sets_of<const AttributeStream>(mesh.attributes);
  std::size_t count = 0;
  Influences influences;
  for (std::size_t w = 0; w < mesh.wedge_count() && !sets.empty(); ++w) {
    gather(sets, w, influences);
    count += influences.size() > most ? 1 : 0;
  }
  return count;
}

void limit_influences(Mesh& mesh, std::size_t most) {
  if (most == 0) return;
  const auto sets = sets_of<AttributeStream>(mesh.attributes);
  std::size_t room = 0;
  for (const auto& set : sets) room += set.joints->components;
  if (room <= most) return;
  Influences influences;
  for (std::size_t w = 0; w < mesh.wedge_count(); ++w) {
    gather(sets, w, influences);
    std::stable_sort(influences.begin(), influences.end(),
                     [](const auto& a, const auto& b) { return a.second > b.second; });
    if (influences.size() > most) {
      float all = 0, kept = 0;
      for (std::size_t i = 0; i < influences.size(); ++i) {
        all += influences[i].second;
        kept += i < most ? influences[i].second : 0;
      }
      influences.resize(most);
      for (auto& influence : influences) influence.second *= all / kept;
    }
    put(sets, w, influences);
  }
  std::size_t first = 0;
  std::vector<std::uint32_t> emptied;
  for (const auto& set : sets) {
    if (first >= most) emptied.push_back(set.joints->set);
    first += set.joints->components;
  }
  std::erase_if(mesh.attributes, [&](const AttributeStream& stream) {
    return (stream.semantic == Semantic::joints || stream.semantic == Semantic::weights) &&
           std::find(emptied.begin(), emptied.end(), stream.set) != emptied.end();
  });
}

}  // namespace lodestone
