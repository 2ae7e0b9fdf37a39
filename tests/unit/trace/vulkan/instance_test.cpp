// SPDX-License-Identifier: Apache-2.0
// Instances with and without the validation layer coexist: neither may lose its functions to the other.
#include "trace/vulkan/instance.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <optional>

#include "trace/vulkan/commands.hpp"
#include "vantage/error.hpp"

namespace vantage::vulkan {
namespace {

// An instance with one of its devices.
class Machine {
 public:
  explicit Machine(bool validation) : validation_(validation), instance_(std::make_shared<Instance>(validation)) {
    for (const VkPhysicalDevice physical : instance_->physical_devices()) {
      const DeviceAbilities abilities = abilities_of(*instance_, physical);
      if (device_ || !abilities.refusal(DeviceNeeds::compute).empty()) continue;
      device_.emplace(instance_, physical, abilities, DeviceNeeds::compute);
      commands_.emplace(*device_);
    }
  }

  // Expects a working device; with the validation layer, it names objects and reports mistakes.
  void expect_well() {
    ASSERT_TRUE(device_) << "no Vulkan device: install mesa-vulkan-drivers >= 24.1";
    std::vector<std::uint32_t> numbers(1000), back(1000);
    std::iota(numbers.begin(), numbers.end(), 0u);
    const Buffer buffer = make_device_buffer<std::uint32_t>(*device_, *commands_, numbers, "numbers");
    commands_->download(buffer, back.data(), back.size() * sizeof back[0]);
    EXPECT_EQ(back, numbers);
    EXPECT_EQ(instance_->vk().vkSetDebugUtilsObjectNameEXT != nullptr, validation_);
    EXPECT_NO_THROW(instance_->check_validation());
    make_a_mistake();
    if (validation_) {
      EXPECT_THROW(instance_->check_validation(), Error);
    } else {
      EXPECT_NO_THROW(instance_->check_validation());
    }
  }

 private:
  void make_a_mistake() {
    VkFenceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
    info.flags = 1u << 20;  // an unknown flag, which drivers ignore
    VkFence fence = VK_NULL_HANDLE;
    ASSERT_EQ(device_->vk().vkCreateFence(device_->handle(), &info, nullptr, &fence), VK_SUCCESS);
    device_->vk().vkDestroyFence(device_->handle(), fence, nullptr);
  }

  bool validation_;
  std::shared_ptr<Instance> instance_;
  std::optional<Device> device_;
  std::optional<Commands> commands_;
};

TEST(Instance, PairsWithAndWithoutValidationLiveAndGoInAnyOrder) {
  for (const bool first_watched : {false, true})
    for (const bool second_watched : {false, true})
      for (const bool first_goes_first : {false, true}) {
        SCOPED_TRACE(testing::Message() << "watched: " << first_watched << ", " << second_watched << "; the first goes "
                                        << (first_goes_first ? "first" : "last"));
        auto first = std::make_unique<Machine>(first_watched);
        first->expect_well();
        auto second = std::make_unique<Machine>(second_watched);
        first->expect_well();
        second->expect_well();
        (first_goes_first ? first : second).reset();
        (first_goes_first ? second : first)->expect_well();
      }
}

TEST(Instance, IsSharedByAllWhoAskForTheSameKind) {
  const auto watched = Instance::get(true), plain = Instance::get(false);
  EXPECT_EQ(Instance::get(true), watched);
  EXPECT_EQ(Instance::get(false), plain);
  EXPECT_NE(watched, plain);
}

}  // namespace
}  // namespace vantage::vulkan
