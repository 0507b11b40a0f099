#include "learner/torch_q_network.h"

#include <torch/torch.h>

#include <cmath>

#include "proto/base/failure.h"
#include "proto/base/random.h"

namespace corridor::learner {
void check_device(Device device) {
  if (device == Device::kCuda && !torch::cuda::is_available()) {
    throw Failure(
        "run.device is 'cuda', but LibTorch {} finds no CUDA device; set run.device = \"cpu\", or "
        "build with a CUDA LibTorch (cmake -DCMAKE_PREFIX_PATH=/opt/libtorch)",
        TORCH_VERSION);
  }
}

void use_one_torch_thread() { at::set_num_threads(1); }

std::vector<float> initial_parameters(const NetworkShape& shape, std::uint64_t seed, Phase phase,
                                      int networks) {
  std::vector<float> values(static_cast<std::size_t>(networks) * shape.parameters());
  for (std::size_t start = 0; start < values.size(); start += shape.parameters()) {
    for (const NetworkShape::Layer& layer : shape.layers()) {
      const double bound = 1.0 / std::sqrt(static_cast<double>(layer.inputs));
      const std::size_t end = start + layer.biases + static_cast<std::size_t>(layer.outputs);
      for (std::size_t i = start + layer.weights; i < end; ++i) {
        const double unit =
            random_unit(seed, Purpose::kInitialWeights, {static_cast<std::uint64_t>(phase), i});
        values[i] = static_cast<float>(bound * (2.0 * unit - 1.0));
      }
    }
  }
  return values;
}

struct QNetwork::Impl {
  NetworkShape shape;
  torch::Device device;
  torch::Tensor parameters;  // [parameters]

  torch::Tensor apply(const NetworkShape::Layer& layer, const torch::Tensor& inputs) const {
    const torch::Tensor weights =
        parameters.narrow(0, static_cast<std::int64_t>(layer.weights), layer.outputs * layer.inputs)
            .view({layer.outputs, layer.inputs});
    const torch::Tensor biases =
        parameters.narrow(0, static_cast<std::int64_t>(layer.biases), layer.outputs);
    return at::addmm(biases, inputs, weights.t());
  }
};

QNetwork::QNetwork(const NetworkShape& shape, Device device) {
  check_device(device);
  const torch::Device where(name_of(device));
  const auto size = static_cast<std::int64_t>(shape.parameters());
  impl_ = std::make_unique<Impl>(
      Impl{shape, where, torch::zeros({size}, torch::dtype(torch::kFloat32).device(where))});
}

QNetwork::~QNetwork() = default;

const NetworkShape& QNetwork::shape() const { return impl_->shape; }

std::vector<float> QNetwork::parameters() const {
  const torch::Tensor host = impl_->parameters.detach().to(torch::kCPU);
  const float* begin = host.data_ptr<float>();
  return {begin, begin + host.numel()};
}

void QNetwork::set_parameters(std::span<const float> values) {
  CORRIDOR_CHECK(values.size() == impl_->shape.parameters(), "{} values for {} parameters",
                 values.size(), impl_->shape.parameters());
  const torch::NoGradGuard no_gradient;
  impl_->parameters.copy_(torch::from_blob(const_cast<float*>(values.data()),
                                           {static_cast<std::int64_t>(values.size())}));
}

std::vector<float> QNetwork::forward(std::span<const float> observations, int batch) const {
  const int inputs = impl_->shape.observations;
  CORRIDOR_CHECK(observations.size() == static_cast<std::size_t>(batch) * inputs,
                 "{} values for {} x {}", observations.size(), batch, inputs);
  const torch::Tensor host =
      torch::from_blob(const_cast<float*>(observations.data()), {batch, inputs});
  const torch::NoGradGuard no_gradient;
  const torch::Tensor q = forward(host.to(impl_->device)).to(torch::kCPU).contiguous();
  return {q.data_ptr<float>(), q.data_ptr<float>() + q.numel()};
}

at::Tensor QNetwork::forward(const at::Tensor& observations) const {
  const std::vector<NetworkShape::Layer> layers = impl_->shape.layers();
  const std::size_t hidden_layers = impl_->shape.hidden.size();
  torch::Tensor hidden = observations;
  for (std::size_t i = 0; i < hidden_layers; ++i) {
    hidden = impl_->apply(layers[i], hidden).relu();
  }
  const torch::Tensor last = impl_->apply(layers.back(), hidden);  // advantages, if dueling
  if (!impl_->shape.dueling) return last;
  const torch::Tensor value = impl_->apply(layers[hidden_layers], hidden);  // [batch, 1]
  return last + (value - last.mean(1, /*keepdim=*/true));
}

at::Tensor& QNetwork::parameter_tensor() { return impl_->parameters; }

}  // namespace corridor::learner
