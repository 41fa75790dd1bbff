#include "transformers/predict/model/body_net.h"

#include <algorithm>

#include "transformers/predict/model/row_kernels.h"

namespace dance {

BodyNet BodyNet::blank() {
  BodyNet net;
  net.mean.resize(kNetInputs);
  net.scale.resize(kNetInputs);
  net.straight.resize(kNetInputs * kNetAnswers);
  net.first.resize(kNetInputs * kNetHidden);
  net.first_bias.resize(kNetHidden);
  net.second.resize(kNetHidden * kNetHidden);
  net.second_bias.resize(kNetHidden);
  net.third.resize(kNetHidden * kNetAnswers);
  net.third_bias.resize(kNetAnswers);
  net.basis.resize(kNetAnswers * kHorizons * kRowSize);
  return net;
}

void BodyNet::normalise(NetInputs& inputs) const {
  for (std::size_t i = 0; i < kNetInputs; ++i)
    inputs[i] = std::clamp((inputs[i] - mean[i]) * scale[i], -kMostInput, kMostInput);
}

void BodyNet::answer(const NetInputs& inputs, NetAnswers& answers) const {
  alignas(64) std::array<float, kNetHidden> one, two;
  std::copy(first_bias.begin(), first_bias.end(), one.begin());
  add_product(inputs.data(), kNetInputs, first.data(), kNetHidden, one.data());
  for (float& x : one) x = std::max(x, 0.0f);
  std::copy(second_bias.begin(), second_bias.end(), two.begin());
  add_product(one.data(), kNetHidden, second.data(), kNetHidden, two.data());
  for (float& x : two) x = std::max(x, 0.0f);
  std::copy(third_bias.begin(), third_bias.end(), answers.begin());
  add_product(two.data(), kNetHidden, third.data(), kNetAnswers, answers.data());
  add_product(inputs.data(), kNetInputs, straight.data(), kNetAnswers, answers.data());
}

void BodyNet::ways_of(const NetAnswers& answers, BodyWays& ways) const {
  for (BodyRow& way : ways) way.v.fill(0.0f);
  for (std::size_t h = 0; h < kHorizons; ++h)
    add_product(answers.data(), kNetAnswers, basis.data() + h * kNetAnswers * kRowSize, kRowSize,
                ways[h].v.data());
}

void BodyNet::ways_of(const NetAnswers& a, BodyWays& ways_a, const NetAnswers& b,
                      BodyWays& ways_b) const {
  for (BodyRow& way : ways_a) way.v.fill(0.0f);
  for (BodyRow& way : ways_b) way.v.fill(0.0f);
  for (std::size_t h = 0; h < kHorizons; ++h)
    add_two_products(a.data(), b.data(), kNetAnswers, basis.data() + h * kNetAnswers * kRowSize,
                     kRowSize, ways_a[h].v.data(), ways_b[h].v.data());
}

}  // namespace dance
