#include "lodestone/core/blend.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lodestone {

namespace {

// Unit length for the first three of `v`; a vector that vanished keeps `fallback`.
void make_unit(float* v, const float* fallback) {
  const float l = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  for (std::size_t k = 0; k < 3; ++k) v[k] = l > 1e-12F ? v[k] / l : fallback[k];
}

void blend_floats(const AttributeStream& stream, float* to, const float* from, float t) {
  const std::size_t n = stream.components;
  if (stream.semantic == Semantic::normal && n == 3) {
    const float before[3] = {to[0], to[1], to[2]};
    for (std::size_t k = 0; k < 3; ++k) to[k] += t * (from[k] - to[k]);
    make_unit(to, before);
    return;
  }
  if (stream.semantic == Semantic::tangent && n == 4) {
    const float before[3] = {to[0], to[1], to[2]};
    for (std::size_t k = 0; k < 3; ++k) to[k] += t * (from[k] - to[k]);
    make_unit(to, before);
    if (t > 0.5F) to[3] = from[3];  // handedness is picked
    return;
  }
  for (std::size_t k = 0; k < n; ++k) to[k] += t * (from[k] - to[k]);
}

}  // namespace

AttributeBlender::AttributeBlender(std::vector<AttributeStream>& streams) : streams_(streams) {
  std::vector<bool> in_skin(streams.size(), false);
  for (std::size_t j = 0; j < streams.size(); ++j) {
    if (streams[j].semantic != Semantic::joints) continue;
    for (std::size_t w = 0; w < streams.size(); ++w) {
      const bool pair = streams[w].semantic == Semantic::weights && streams[w].set == streams[j].set &&
                        streams[w].components == streams[j].components &&
                        std::holds_alternative<std::vector<float>>(streams[w].values) &&
                        std::holds_alternative<std::vector<std::uint32_t>>(streams[j].values);
      if (!pair || in_skin[w]) continue;
      in_skin[j] = in_skin[w] = true;
      skin_.push_back({j, w});
    }
  }
  for (std::size_t i = 0; i < streams.size(); ++i) {
    if (!in_skin[i]) plain_.push_back(i);
  }
}

void AttributeBlender::blend(std::uint32_t to, std::uint32_t from, float t) {
  if (!(t > 0) || to == from) return;
  for (const std::size_t i : plain_) {
    AttributeStream& stream = streams_[i];
    const std::size_t n = stream.components;
    if (auto* floats = std::get_if<std::vector<float>>(&stream.values)) {
      blend_floats(stream, floats->data() + to * n, floats->data() + from * n, t);
    } else if (auto* doubles = std::get_if<std::vector<double>>(&stream.values)) {
      for (std::size_t k = 0; k < n; ++k) {
        (*doubles)[to * n + k] += double{t} * ((*doubles)[from * n + k] - (*doubles)[to * n + k]);
      }
    } else if (auto* picked = std::get_if<std::vector<std::uint32_t>>(&stream.values); t > 0.5F) {
      for (std::size_t k = 0; k < n; ++k) (*picked)[to * n + k] = (*picked)[from * n + k];
    }
  }
  if (!skin_.empty()) blend_skin(to, from, t);
}

void AttributeBlender::blend_skin(std::uint32_t to, std::uint32_t from, float t) {
  influences_.clear();
  float sum_before = 0;
  const auto gather = [&](std::uint32_t wedge, float share) {
    for (const SkinSet& set : skin_) {
      const std::size_t n = streams_[set.joints].components;
      const auto& joints = std::get<std::vector<std::uint32_t>>(streams_[set.joints].values);
      const auto& weights = std::get<std::vector<float>>(streams_[set.weights].values);
      for (std::size_t k = 0; k < n; ++k) {
        const float weight = weights[wedge * n + k] * share;
        sum_before += weight;
        if (weight <= 0) continue;
        const std::uint32_t joint = joints[wedge * n + k];
        const auto found = std::find_if(influences_.begin(), influences_.end(),
                                        [&](const auto& influence) { return influence.first == joint; });
        if (found != influences_.end()) {
          found->second += weight;
        } else {
          influences_.emplace_back(joint, weight);
        }
      }
    }
  };
  gather(to, 1 - t);
  gather(from, t);
  std::sort(influences_.begin(), influences_.end(), [](const auto& a, const auto& b) {
    return a.second != b.second ? a.second > b.second : a.first < b.first;
  });
  std::size_t room = 0;
  for (const SkinSet& set : skin_) room += streams_[set.joints].components;
  if (influences_.size() > room) influences_.resize(room);
  float sum = 0;
  for (const auto& influence : influences_) sum += influence.second;
  const float scale = sum > 0 ? sum_before / sum : 0;
  std::size_t next = 0;
  for (const SkinSet& set : skin_) {
    const std::size_t n = streams_[set.joints].components;
    auto& joints = std::get<std::vector<std::uint32_t>>(streams_[set.joints].values);
    auto& weights = std::get<std::vector<float>>(streams_[set.weights].values);
    for (std::size_t k = 0; k < n; ++k, ++next) {
      const bool filled = next < influences_.size();
      joints[to * n + k] = filled ? influences_[next].first : 0;
      weights[to * n + k] = filled ? influences_[next].second * scale : 0;
    }
  }
}

}  // namespace lodestone
