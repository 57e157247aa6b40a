#include "pipelines/deep_pixels.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>

namespace sfumato::pipelines {
namespace {

using glm::dvec3;
using image::DeepSample;

// Of a ray, or of the mean of a pixel's rays, at a depth.
struct State {
  dvec3 radiance{0};    // added so far
  dvec3 throughput{1};  // of light from behind
  bool operator==(const State&) const = default;
};

double meanOf(const dvec3& v) {
  return (v.x + v.y + v.z) / 3;
}

// The part of what a homogeneous medium adds over its length that is added over a fraction of it, where it
// passes `ratio` of the light over its length and `partRatio` over the fraction.
double partAdded(double fraction, double ratio, double partRatio) {
  return 1 - ratio > 1e-9 ? (1 - partRatio) / (1 - ratio) : fraction;
}

// Walks what a ray met, to ever larger depths.
class RayCursor {
 public:
  explicit RayCursor(const RayEvents& events) : events_(&events) {}

  // At `depth`, before the surfaces there or behind them.
  State at(double depth, bool behindSurfaces) {
    while (next_ < events_->size()) {
      const shared::DeepEvent& event = (*events_)[next_];
      const bool isSurface = event.front == event.back;
      if (event.back > depth || (event.back == depth && isSurface && !behindSurfaces)) break;
      state_ = endOf(event);
      ++next_;
    }
    if (next_ == events_->size() || (*events_)[next_].front >= depth) return state_;
    return inside((*events_)[next_], depth);
  }

 private:
  State endOf(const shared::DeepEvent& event) const {
    return {state_.radiance + dvec3(event.addedR, event.addedG, event.addedB),
            {event.throughputR, event.throughputG, event.throughputB}};
  }

  State inside(const shared::DeepEvent& event, double depth) const {
    const double fraction = (depth - event.front) / (event.back - event.front);
    State part = endOf(event);
    for (int c = 0; c < 3; ++c) {
      const double before = state_.throughput[c];
      const double ratio = before > 0 ? part.throughput[c] / before : 0;
      const double partRatio = std::pow(ratio, fraction);
      const double added = part.radiance[c] - state_.radiance[c];
      part.radiance[c] = state_.radiance[c] + added * partAdded(fraction, ratio, partRatio);
      part.throughput[c] = before * partRatio;
    }
    return part;
  }

  const RayEvents* events_;
  size_t next_ = 0;
  State state_;  // before it
};

// A depth at which something begins or ends, with the mean of the rays before and behind what stands there.
struct Node {
  double depth = 0;
  State before;
  State after;
  bool hasSurface() const { return before != after; }
};

// Into how many parts a step is cut, so that its samples may end there: those that are optically thick, and
// those that take far more of one colour than of another, which one exponential for all colours is not like.
int partsOf(const shared::DeepEvent& step, const dvec3& before) {
  const dvec3 after(step.throughputR, step.throughputG, step.throughputB);
  double least = std::numeric_limits<double>::infinity();
  double most = 0;
  for (int c = 0; c < 3; ++c) {
    if (!(before[c] > 0)) continue;
    const double tau = std::log(before[c] / std::max(after[c], 1e-12 * before[c]));
    least = std::min(least, tau);
    most = std::max(most, tau);
  }
  return static_cast<int>(std::clamp(std::ceil(std::max(2 * most, 12 * (most - least))), 1.0, 32.0));
}

// Depths at which some ray's medium begins or ends, and some inside its steps.
std::vector<float> depthsOf(std::span<const RayEvents> rays) {
  std::vector<float> depths;
  for (const RayEvents& events : rays) {
    dvec3 throughput(1);
    for (const shared::DeepEvent& event : events) {
      depths.push_back(event.front);
      if (event.back > event.front) {
        const int parts = partsOf(event, throughput);
        for (int i = 1; i < parts; ++i)
          depths.push_back(
              std::lerp(event.front, event.back, static_cast<float>(i) / static_cast<float>(parts)));
        depths.push_back(event.back);
      }
      throughput = {event.throughputR, event.throughputG, event.throughputB};
    }
  }
  std::ranges::sort(depths);
  depths.erase(std::unique(depths.begin(), depths.end()), depths.end());
  return depths;
}

std::vector<Node> nodesOf(std::span<const RayEvents> rays) {
  std::vector<RayCursor> cursors(rays.begin(), rays.end());
  const double share = 1.0 / static_cast<double>(rays.size());
  const auto mean = [&](double depth, bool behindSurfaces) {
    State sum{dvec3(0), dvec3(0)};
    for (RayCursor& cursor : cursors) {
      const State state = cursor.at(depth, behindSurfaces);
      sum.radiance += share * state.radiance;
      sum.throughput += share * state.throughput;
    }
    return sum;
  };
  std::vector<Node> nodes;
  for (const double depth : depthsOf(rays)) {
    Node node{depth, mean(depth, false), {}};
    node.after = mean(depth, true);
    nodes.push_back(node);
  }
  return nodes;
}

// Of what a shadow map's texel holds.
std::vector<Node> nodesOf(std::span<const shared::ShadowKnot> knots, double opaqueDepth) {
  std::vector<Node> nodes;
  State light;
  const auto pass = [&](double depth, const dvec3& throughput) {
    const State behind{dvec3(0), glm::min(light.throughput, throughput)};
    if (!nodes.empty() && nodes.back().depth == depth)
      nodes.back().after = behind;
    else
      nodes.push_back({depth, behind, behind});
    light = behind;
  };
  for (const shared::ShadowKnot& knot : knots)
    if (knot.depth < opaqueDepth) pass(knot.depth, glm::exp(-dvec3(knot.tauR, knot.tauG, knot.tauB)));
  if (opaqueDepth < NOTHING_OPAQUE) {
    pass(opaqueDepth, light.throughput);
    pass(opaqueDepth, dvec3(0));
  }
  return nodes;
}

// Of the error that is allowed, what is used at nodes, as between them it is larger by up to a tenth.
constexpr double errorAtNodes = 0.75;

// Makes samples of nodes.
class Sampler {
 public:
  Sampler(std::span<const Node> nodes, double error) : nodes_(nodes), error_(errorAtNodes * error) {
    if (nodes.empty()) return;
    const dvec3& all = nodes.back().after.radiance;
    radianceError_ = error_ * std::max({all.x, all.y, all.z});
    grey_ = std::ranges::all_of(nodes, [](const Node& node) {
      const dvec3& t = node.after.throughput;
      return t.x == t.y && t.x == t.z;
    });
  }

  std::vector<DeepSample> samples() {
    for (size_t i = 0; i < nodes_.size();) {
      const Node& node = nodes_[i];
      if (node.hasSurface()) add(node.depth, node.before, node.depth, node.after);
      size_t last = i + 1;
      if (last < nodes_.size() && !isEmpty(i)) {
        last = farthest(i);
        size_t full = last;
        while (isEmpty(full - 1)) --full;
        add(node.depth, node.after, nodes_[full].depth, nodes_[full].before);
      }
      i = last;
    }
    return std::move(samples_);
  }

 private:
  // Nothing from node i to the next one.
  bool isEmpty(size_t i) const { return nodes_[i].after == nodes_[i + 1].before; }

  // The last node to which one sample from node `first` on may reach.
  size_t farthest(size_t first) const {
    size_t end = first + 1;  // no sample reaches beyond the next surface
    while (end + 1 < nodes_.size() && !nodes_[end].hasSurface()) ++end;
    size_t good = first + 1;
    size_t bad = end + 1;
    for (size_t step = 1; good < end && bad > end; step *= 2) {
      const size_t tried = std::min(good + step, end);
      (fits(first, tried) ? good : bad) = tried;
    }
    while (bad <= end && bad - good > 1) {
      const size_t middle = (good + bad) / 2;
      (fits(first, middle) ? good : bad) = middle;
    }
    return good;
  }

  // Whether a sample from one node to another is close enough to those between.
  bool fits(size_t first, size_t last) const {
    const State& from = nodes_[first].after;
    const State& to = nodes_[last].before;
    const double length = nodes_[last].depth - nodes_[first].depth;
    const double start = meanOf(from.throughput);
    const double ratio = meanOf(to.throughput) / start;
    const double logRatio = std::log(ratio);
    for (size_t i = first + 1; i < last; ++i) {
      const State& exact = nodes_[i].before;
      const double fraction = (nodes_[i].depth - nodes_[first].depth) / length;
      const double partRatio = std::exp(fraction * logRatio);
      const double added = partAdded(fraction, ratio, partRatio);
      if (std::abs(start * partRatio - meanOf(exact.throughput)) > error_) return false;
      const dvec3 off = from.radiance + added * (to.radiance - from.radiance) - exact.radiance;
      if (std::max({std::abs(off.x), std::abs(off.y), std::abs(off.z)}) > radianceError_) return false;
      for (int c = 0; c < 3 && !grey_; ++c) {
        const double passed =
            from.throughput[c] > 0 ? std::pow(to.throughput[c] / from.throughput[c], fraction) : 0;
        if (std::abs(from.throughput[c] * passed - exact.throughput[c]) > error_) return false;
      }
    }
    return true;
  }

  void add(double z, const State& from, double zBack, const State& to) {
    const double before = meanOf(from.throughput);
    if (before <= 0) return;  // hidden
    const dvec3 added = (to.radiance - from.radiance) / before;
    DeepSample sample{static_cast<float>(z), static_cast<float>(zBack)};
    sample.alpha = static_cast<float>(1 - meanOf(to.throughput) / before);
    for (int c = 0; c < 3; ++c) {
      const auto channel = static_cast<size_t>(c);
      sample.colour[channel] = static_cast<float>(added[c]);
      const double taken = from.throughput[c] > 0 ? 1 - to.throughput[c] / from.throughput[c] : 1;
      sample.takes[channel] = grey_ ? sample.alpha : static_cast<float>(taken);
    }
    samples_.push_back(sample);
  }

  std::span<const Node> nodes_;
  double error_;
  double radianceError_ = 0;
  bool grey_ = true;
  std::vector<DeepSample> samples_;
};

}  // namespace

std::vector<DeepSample> joinRays(std::span<const RayEvents> rays, double error) {
  return Sampler(nodesOf(rays), error).samples();
}

std::vector<DeepSample> samplesOf(std::span<const shared::ShadowKnot> knots, float opaqueDepth) {
  constexpr double asTheMapHasThem = 0;
  return Sampler(nodesOf(knots, opaqueDepth), asTheMapHasThem).samples();
}

}  // namespace sfumato::pipelines
