// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/embree_version.h"

#include "lanthorn/error.h"
#include "scene/embree.h"

namespace lanthorn {

std::string version_of_embree() {
  const RTCDevice device = rtcNewDevice(nullptr);
  if (device == nullptr) throw Error("Embree cannot be started on this machine");
  const auto number = rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_VERSION);
  rtcReleaseDevice(device);
  return std::to_string(number / 10000) + '.' + std::to_string(number / 100 % 100) + '.' + std::to_string(number % 100);
}

}  // namespace lanthorn
