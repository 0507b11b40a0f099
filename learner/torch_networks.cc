// SPDX-License-Identifier: Apache-2.0
#include <torch/torch.h>

#include "learner/td_networks.h"
#include "proto/base/failure.h"

namespace corridor::learner {
namespace {

torch::Tensor view(std::span<const float> values) {
  return torch::from_blob(const_cast<float*>(values.data()),
                          {static_cast<std::int64_t>(values.size())});
}

std::span<const float> values(const torch::Tensor& host) {
  return {host.data_ptr<float>(), static_cast<std::size_t>(host.numel())};
}

std::vector<float> copy(const torch::Tensor& tensor) {
  const torch::Tensor host = tensor.detach().to(torch::kCPU);
  return {host.data_ptr<float>(), host.data_ptr<float>() + host.numel()};
}

// Networks as flat tensors [parameters], so that copies, checkpoints and Adam touch one array.
class TorchNetworks : public TdNetworks {
 public:
  TorchNetworks(const NetworkShape& shape, const DqnSettings& dqn, Device device,
                const TdState& state)
      : shape_(shape),
        dqn_(dqn),
        device_(name_of(device)),
        online_(view(state.online).clone().to(device_)),
        target_(view(state.target).clone().to(device_)) {
    // Adam sees one parameter, the flat vector. It makes its state in its first step; with a
    // gradient of 0 that step moves nothing.
    online_.set_requires_grad(true);
    online_.mutable_grad() = torch::zeros_like(online_);
    adam_ = std::make_unique<torch::optim::Adam>(std::vector<torch::Tensor>{online_},
                                                 torch::optim::AdamOptions().eps(dqn.adam_epsilon));
    adam_->step();
    moments().exp_avg().copy_(view(state.mean_gradient));
    moments().exp_avg_sq().copy_(view(state.mean_squared_gradient));
    moments().step(static_cast<std::int64_t>(state.updates));
  }

  BatchQValues forward(std::span<const float> rows, int batch) override {
    const torch::Tensor all =  // [batch, stride]
        view(rows).view({batch, -1}).to(device_);
    const torch::Tensor next = all.narrow(1, shape_.observations, shape_.observations);
    {
      const torch::NoGradGuard no_gradient;
      target_next_ = q_values(target_, next).to(torch::kCPU).contiguous();
      if (dqn_.double_q) online_next_ = q_values(online_, next).to(torch::kCPU).contiguous();
    }
    online_q_ = q_values(online_, all.narrow(1, 0, shape_.observations));
    host_q_ = online_q_.detach().to(torch::kCPU).contiguous();
    BatchQValues q;
    q.online = values(host_q_);
    q.target_next = values(target_next_);
    if (dqn_.double_q) q.online_next = values(online_next_);
    return q;
  }

  double step(std::span<const float> q_gradient, double learning_rate) override {
    torch::Tensor& gradient = online_.mutable_grad();
    gradient.zero_();
    online_q_.backward(view(q_gradient).view(online_q_.sizes()).to(device_));
    const torch::NoGradGuard no_gradient;
    const double size = gradient.norm().item<double>();
    if (size > dqn_.gradient_norm_max) gradient.mul_(dqn_.gradient_norm_max / size);
    static_cast<torch::optim::AdamOptions&>(adam_->param_groups()[0].options()).lr(learning_rate);
    adam_->step();
    return size;
  }

  void copy_to_target() override {
    const torch::NoGradGuard no_gradient;
    target_.copy_(online_);
  }

  std::vector<float> parameters() const override { return copy(online_); }

  TdState state() const override {
    return {copy(online_), copy(target_), copy(moments().exp_avg()), copy(moments().exp_avg_sq()),
            static_cast<std::uint64_t>(moments().step())};
  }

 private:
  // [batch, actions] for observations [batch, observations]; differentiable in `parameters`.
  torch::Tensor q_values(const torch::Tensor& parameters, const torch::Tensor& observations) const {
    const auto apply = [&](const NetworkShape::Layer& layer, const torch::Tensor& inputs) {
      const torch::Tensor weights = parameters.narrow(0, static_cast<std::int64_t>(layer.weights),
                                                      layer.outputs * layer.inputs);
      const torch::Tensor biases =
          parameters.narrow(0, static_cast<std::int64_t>(layer.biases), layer.outputs);
      return at::addmm(biases, inputs, weights.view({layer.outputs, layer.inputs}).t());
    };
    const std::vector<NetworkShape::Layer> layers = shape_.layers();
    const std::size_t hidden_layers = shape_.hidden.size();
    torch::Tensor hidden = observations;
    for (std::size_t i = 0; i < hidden_layers; ++i) hidden = apply(layers[i], hidden).relu();
    const torch::Tensor last = apply(layers.back(), hidden);  // advantages, if dueling
    if (!shape_.dueling) return last;
    const torch::Tensor value = apply(layers[hidden_layers], hidden);  // [batch, 1]
    return last + (value - last.mean(1, /*keepdim=*/true));
  }

  torch::optim::AdamParamState& moments() const {
    return static_cast<torch::optim::AdamParamState&>(*adam_->state().begin()->second);
  }

  NetworkShape shape_;
  DqnSettings dqn_;
  torch::Device device_;
  torch::Tensor online_;
  torch::Tensor target_;
  std::unique_ptr<torch::optim::Adam> adam_;

  // Of the last forward pass; all but online_q_ on the host.
  torch::Tensor online_q_;
  torch::Tensor host_q_;
  torch::Tensor online_next_;
  torch::Tensor target_next_;
};

}  // namespace

void check_device(Device device) {
  if (device == Device::kCuda && !torch::cuda::is_available()) {
    throw Failure(
        "run.device is 'cuda', but LibTorch {} finds no CUDA device; set run.device = \"cpu\", or "
        "build with a CUDA LibTorch (cmake -DCMAKE_PREFIX_PATH=/opt/libtorch)",
        TORCH_VERSION);
  }
}

void use_one_torch_thread() { at::set_num_threads(1); }

std::unique_ptr<TdNetworks> torch_networks(const NetworkShape& shape, const DqnSettings& dqn,
                                           Device device, const TdState& state) {
  check_device(device);
  return std::make_unique<TorchNetworks>(shape, dqn, device, state);
}

}  // namespace corridor::learner
