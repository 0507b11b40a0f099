#include "learner/q_network.h"

#include <torch/torch.h>

#include <cmath>

#include "proto/failure.h"
#include "proto/random.h"

namespace corridor::learner {
void check_device(const std::string& device) {
  if (device == "cpu") return;
  if (device != "cuda") throw Failure("run.device is '{}'; it must be 'cpu' or 'cuda'", device);
  if (!torch::cuda::is_available()) {
    throw Failure(
        "run.device is 'cuda', but LibTorch {} finds no CUDA device; set run.device = \"cpu\", or "
        "build with a CUDA LibTorch (cmake -DCMAKE_PREFIX_PATH=/opt/libtorch)",
        TORCH_VERSION);
  }
}

void use_one_torch_thread() { at::set_num_threads(1); }

std::vector<float> initial_parameters(const NetworkShape& shape, std::uint64_t seed, Phase phase) {
  std::vector<float> values(shape.parameters());
  for (const NetworkShape::Layer& layer : shape.layers()) {
    const double bound = 1.0 / std::sqrt(static_cast<double>(layer.inputs));
    const std::size_t end = layer.biases + static_cast<std::size_t>(layer.outputs);
    for (std::size_t i = layer.weights; i < end; ++i) {
      const double unit =
          random_unit(seed, Purpose::kInitialWeights, {static_cast<std::uint64_t>(phase), i});
      values[i] = static_cast<float>(bound * (2.0 * unit - 1.0));
    }
  }
  return values;
}

struct QNetwork::Impl {
  // Views of the flat tensors.
  struct Linear {
    torch::Tensor weights;           // [out, in]
    torch::Tensor biases;            // [out]
    torch::Tensor weights_gradient;  // [out, in]
    torch::Tensor biases_gradient;   // [out]

    torch::Tensor forward(const torch::Tensor& inputs) const {
      return at::addmm(biases, inputs, weights.t());
    }
    void backward(const torch::Tensor& inputs, const torch::Tensor& output_gradient) {
      at::mm_out(weights_gradient, output_gradient.t(), inputs);
      at::sum_out(biases_gradient, output_gradient, 0);
    }
  };

  NetworkShape shape;
  torch::Device device;
  torch::Tensor parameters;  // [parameters]
  torch::Tensor gradient;    // [parameters]
  std::vector<Linear> layers;

  std::size_t hidden_layers() const { return shape.hidden.size(); }
};

QNetwork::QNetwork(const NetworkShape& shape, const std::string& device) {
  check_device(device);
  const torch::Device where(device);
  const auto size = static_cast<std::int64_t>(shape.parameters());
  const auto options = torch::dtype(torch::kFloat32).device(where);
  impl_ = std::make_unique<Impl>(
      Impl{shape, where, torch::zeros({size}, options), torch::zeros({size}, options), {}});
  for (const NetworkShape::Layer& layer : shape.layers()) {
    const auto weights = [&](const torch::Tensor& flat) {
      return flat.narrow(0, static_cast<std::int64_t>(layer.weights), layer.outputs * layer.inputs)
          .view({layer.outputs, layer.inputs});
    };
    const auto biases = [&](const torch::Tensor& flat) {
      return flat.narrow(0, static_cast<std::int64_t>(layer.biases), layer.outputs);
    };
    impl_->layers.push_back({weights(impl_->parameters), biases(impl_->parameters),
                             weights(impl_->gradient), biases(impl_->gradient)});
  }
}

QNetwork::~QNetwork() = default;

const NetworkShape& QNetwork::shape() const { return impl_->shape; }

std::vector<float> QNetwork::parameters() const {
  const torch::Tensor host = impl_->parameters.to(torch::kCPU);
  const float* begin = host.data_ptr<float>();
  return {begin, begin + host.numel()};
}

void QNetwork::set_parameters(std::span<const float> values) {
  CORRIDOR_CHECK(values.size() == impl_->shape.parameters(), "{} values for {} parameters",
                 values.size(), impl_->shape.parameters());
  impl_->parameters.copy_(torch::from_blob(const_cast<float*>(values.data()),
                                           {static_cast<std::int64_t>(values.size())}));
}

std::vector<float> QNetwork::forward(std::span<const float> observations, int batch) const {
  const int inputs = impl_->shape.observations;
  CORRIDOR_CHECK(observations.size() == static_cast<std::size_t>(batch) * inputs,
                 "{} values for {} x {}", observations.size(), batch, inputs);
  const torch::Tensor host =
      torch::from_blob(const_cast<float*>(observations.data()), {batch, inputs});
  const torch::Tensor q = forward(host.to(impl_->device)).to(torch::kCPU).contiguous();
  return {q.data_ptr<float>(), q.data_ptr<float>() + q.numel()};
}

at::Tensor QNetwork::forward(const at::Tensor& observations,
                             std::vector<at::Tensor>* layer_inputs) const {
  const std::vector<Impl::Linear>& layers = impl_->layers;
  torch::Tensor hidden = observations;
  if (layer_inputs != nullptr) layer_inputs->assign({hidden});
  for (std::size_t i = 0; i < impl_->hidden_layers(); ++i) {
    hidden = layers[i].forward(hidden).relu_();
    if (layer_inputs != nullptr) layer_inputs->push_back(hidden);
  }
  const torch::Tensor last = layers.back().forward(hidden);  // Q-values, or advantages if dueling
  if (!impl_->shape.dueling) return last;
  const torch::Tensor value = layers[impl_->hidden_layers()].forward(hidden);  // [batch, 1]
  return last + (value - last.mean(1, /*keepdim=*/true));
}

void QNetwork::backward(const std::vector<at::Tensor>& layer_inputs, const at::Tensor& q_gradient) {
  std::vector<Impl::Linear>& layers = impl_->layers;
  const torch::Tensor& hidden = layer_inputs.back();
  torch::Tensor last = q_gradient;  // d loss / d the last layer's outputs
  torch::Tensor input_gradient;     // d loss / d `hidden`
  if (impl_->shape.dueling) {
    Impl::Linear& value_head = layers[impl_->hidden_layers()];
    const torch::Tensor value = q_gradient.sum(1, /*keepdim=*/true);  // [batch, 1]
    last = q_gradient - value / impl_->shape.actions;
    value_head.backward(hidden, value);
    input_gradient = at::mm(last, layers.back().weights).addmm_(value, value_head.weights);
  } else {
    input_gradient = at::mm(last, layers.back().weights);
  }
  layers.back().backward(hidden, last);

  for (std::size_t i = impl_->hidden_layers(); i-- > 0;) {
    // layer_inputs[i + 1] is layer i's output after its ReLU, which passes what is above 0.
    const torch::Tensor outputs = at::threshold_backward(input_gradient, layer_inputs[i + 1], 0);
    layers[i].backward(layer_inputs[i], outputs);
    if (i > 0) input_gradient = at::mm(outputs, layers[i].weights);
  }
}

at::Tensor& QNetwork::parameter_tensor() { return impl_->parameters; }
const at::Tensor& QNetwork::gradient_tensor() { return impl_->gradient; }

}  // namespace corridor::learner
