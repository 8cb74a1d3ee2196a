// NanoVDB's ray marching on the same GPU as `brume bench volumes/fog_sphere`: the same sphere, camera and steps.
// Needs CUDA and libnanovdb-dev; not part of the build:
//
//   nvcc -O3 -std=c++17 --extended-lambda -I NANOVDB_INCLUDE bench/peers/nanovdb_fog.cu -o nanovdb_fog && ./nanovdb_fog
#include <cuda_runtime.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#define NANOVDB_USE_CUDA
#include <nanovdb/NanoVDB.h>
#include <nanovdb/util/HDDA.h>
#include <nanovdb/util/Primitives.h>
#include <nanovdb/util/Ray.h>
#include <nanovdb/util/SampleFromVoxels.h>

namespace {

constexpr int kWidth = 1920, kHeight = 1080, kRuns = 200, kWarmUp = 50;
constexpr float kRadius = 100, kDistance = 400, kFov = 0.785398f, kExtinction = 0.01f, kStep = 0.5f;

void check(cudaError_t error, const char* what) {
  if (error == cudaSuccess) return;
  std::fprintf(stderr, "%s: %s\n", what, cudaGetErrorString(error));
  std::exit(1);
}

using Grid = nanovdb::NanoGrid<float>;
using Ray = nanovdb::Ray<float>;
using Vec = nanovdb::Vec3<float>;

/// The ray of a pixel in index space, clipped to the active voxels.
__device__ bool ray_of_pixel(const Grid& grid, int x, int y, Ray& ray) {
  const float tall = tanf(kFov / 2), aspect = float(kWidth) / kHeight;
  const Vec direction((2 * (x + 0.5f) / kWidth - 1) * tall * aspect, (1 - 2 * (y + 0.5f) / kHeight) * tall, -1);
  ray = Ray(Vec(0, 0, kDistance), direction * (1 / direction.length())).worldToIndexF(grid);
  return ray.clip(grid.indexBBox().template asReal<float>());
}

/// Beer-Lambert in equal steps, skipping empty leaves as NanoVDB's example does with a TreeMarcher.
template <int kOrder>
__global__ void march(const Grid* grid, float* image) {
  const int x = blockIdx.x * blockDim.x + threadIdx.x, y = blockIdx.y * blockDim.y + threadIdx.y;
  if (x >= kWidth || y >= kHeight) return;
  auto accessor = grid->getAccessor();
  const auto sampler = nanovdb::createSampler<kOrder>(accessor);
  Ray ray(Vec(0), Vec(0, 0, 1));
  float transmittance = 1;
  if (ray_of_pixel(*grid, x, y, ray)) {
    for (float t = ray.t0(); t < ray.t1(); t += kStep)
      transmittance *= expf(-kExtinction * kStep * sampler(ray(t)));
  }
  image[y * kWidth + x] = transmittance;
}

template <int kOrder>
void measure(const char* name, const Grid* grid, float* image) {
  cudaEvent_t begin, end;
  check(cudaEventCreate(&begin), "cudaEventCreate");
  check(cudaEventCreate(&end), "cudaEventCreate");
  const dim3 block(8, 8), blocks((kWidth + 7) / 8, (kHeight + 7) / 8);
  std::vector<float> times;
  for (int run = 0; run < kWarmUp + kRuns; ++run) {
    check(cudaEventRecord(begin), "cudaEventRecord");
    march<kOrder><<<blocks, block>>>(grid, image);
    check(cudaGetLastError(), "march");
    check(cudaEventRecord(end), "cudaEventRecord");
    check(cudaEventSynchronize(end), "cudaEventSynchronize");
    float milliseconds = 0;
    check(cudaEventElapsedTime(&milliseconds, begin, end), "cudaEventElapsedTime");
    if (run >= kWarmUp) times.push_back(milliseconds);
  }
  std::sort(times.begin(), times.end());
  std::vector<float> pixels(kWidth * kHeight);
  check(cudaMemcpy(pixels.data(), image, pixels.size() * sizeof(float), cudaMemcpyDeviceToHost), "cudaMemcpy");
  std::printf("%-10s median %8.4f min %8.4f max %8.4f ms; transmittance in the middle %.4f\n", name,
              times[times.size() / 2], times.front(), times.back(), pixels[kHeight / 2 * kWidth + kWidth / 2]);
}

}  // namespace

int main() {
  const auto handle = nanovdb::createFogVolumeSphere<float>(kRadius, nanovdb::Vec3<float>(0), 1.0, 3.0);
  void* grid = nullptr;
  float* image = nullptr;
  check(cudaMalloc(&grid, handle.size()), "cudaMalloc");
  check(cudaMalloc(&image, sizeof(float) * kWidth * kHeight), "cudaMalloc");
  check(cudaMemcpy(grid, handle.data(), handle.size(), cudaMemcpyHostToDevice), "cudaMemcpy");
  std::printf("NanoVDB: %llu bytes, %.2f bytes per active voxel\n", static_cast<unsigned long long>(handle.size()),
              double(handle.size()) / double(handle.grid<float>()->activeVoxelCount()));
  measure<0>("nearest", static_cast<const Grid*>(grid), image);
  measure<1>("trilinear", static_cast<const Grid*>(grid), image);
  return 0;
}
