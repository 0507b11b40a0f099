#include "learner/torch_q_network.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "proto/base/failure.h"

namespace corridor::learner {
namespace {

using testing::FloatNear;
using testing::HasSubstr;
using testing::Pointwise;

// The definition in proto/settings/transition.h, in plain doubles.
std::vector<float> reference_forward(const NetworkShape& shape, const std::vector<float>& p,
                                     std::vector<double> input) {
  const auto apply = [&](const NetworkShape::Layer& layer, const std::vector<double>& x) {
    std::vector<double> y;
    for (int o = 0; o < layer.outputs; ++o) {
      double sum = p[layer.biases + o];
      for (int i = 0; i < layer.inputs; ++i) sum += p[layer.weights + o * layer.inputs + i] * x[i];
      y.push_back(sum);
    }
    return y;
  };
  const std::vector<NetworkShape::Layer> layers = shape.layers();
  for (std::size_t i = 0; i < shape.hidden.size(); ++i) {
    input = apply(layers[i], input);
    for (double& value : input) value = std::max(value, 0.0);
  }
  std::vector<double> q = apply(layers.back(), input);
  if (shape.dueling) {
    const double value = apply(layers[layers.size() - 2], input)[0];
    const double mean = std::accumulate(q.begin(), q.end(), 0.0) / static_cast<double>(q.size());
    for (double& action_value : q) action_value += value - mean;
  }
  return {q.begin(), q.end()};
}

TEST(QNetwork, ComputesTheNetworkThatItsShapeDefines) {
  for (const bool dueling : {false, true}) {
    for (const std::vector<int>& hidden : {std::vector<int>{}, {7}, {8, 5}}) {
      const NetworkShape shape{6, hidden, 4, dueling};
      const std::vector<float> parameters = initial_parameters(shape, 3, Phase::kBp);
      QNetwork network(shape, Device::kCpu);
      network.set_parameters(parameters);
      std::vector<float> observations, expected;
      for (int row = 0; row < 3; ++row) {
        std::vector<double> observation;
        for (int i = 0; i < 6; ++i) observation.push_back(std::sin(6 * row + i));
        observations.insert(observations.end(), observation.begin(), observation.end());
        const std::vector<float> rounded(observations.end() - 6, observations.end());
        const std::vector<float> q =
            reference_forward(shape, parameters, {rounded.begin(), rounded.end()});
        expected.insert(expected.end(), q.begin(), q.end());
      }
      EXPECT_THAT(network.forward(observations, 3), Pointwise(FloatNear(1e-6f), expected))
          << hidden.size() << " hidden layers, dueling " << dueling;
    }
  }
}

TEST(QNetwork, GivesBackTheParametersThatItWasGiven) {
  const NetworkShape shape{6, {8, 5}, 4, true};
  const std::vector<float> parameters = initial_parameters(shape, 1, Phase::kMop);
  QNetwork network(shape, Device::kCpu);
  network.set_parameters(parameters);
  EXPECT_EQ(network.parameters(), parameters);
}

TEST(QNetwork, RefusesADeviceThatIsNotThere) {
  try {
    QNetwork(NetworkShape{2, {}, 2, false}, Device::kCuda);
    GTEST_SKIP() << "it is there";
  } catch (const Failure& failure) {
    EXPECT_THAT(failure.what(), HasSubstr("finds no CUDA device"));
  }
}

TEST(InitialParameters, AreUniformWithinOneOverTheRootOfTheFanIn) {
  const NetworkShape shape{100, {400}, 3, false};
  const std::vector<float> parameters = initial_parameters(shape, 7, Phase::kMop);
  ASSERT_EQ(parameters.size(), shape.parameters());
  const std::vector<float> first(parameters.begin(), parameters.begin() + 100 * 400);
  double sum = 0.0, squares = 0.0;
  float largest = 0.0f;
  for (const float value : first) {
    sum += value;
    squares += static_cast<double>(value) * value;
    largest = std::max(largest, std::abs(value));
  }
  EXPECT_LE(largest, 0.1f);
  EXPECT_GT(largest, 0.0999f);
  EXPECT_NEAR(sum / 40'000, 0.0, 4 * 0.1 / std::sqrt(3 * 40'000));
  EXPECT_NEAR(squares / 40'000, 0.01 / 3.0, 4 * 0.01 / std::sqrt(40'000.0) / 3.0);
}

TEST(InitialParameters, DependOnSeedAndPhaseOnly) {
  const NetworkShape shape{4, {8}, 3, false};
  EXPECT_EQ(initial_parameters(shape, 7, Phase::kMop), initial_parameters(shape, 7, Phase::kMop));
  EXPECT_NE(initial_parameters(shape, 7, Phase::kMop), initial_parameters(shape, 8, Phase::kMop));
  EXPECT_NE(initial_parameters(shape, 7, Phase::kMop), initial_parameters(shape, 7, Phase::kBp));
}

}  // namespace
}  // namespace corridor::learner
