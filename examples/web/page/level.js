// The level of scenes/demo.toml and its doors: the free voxels of their openings.
export const LEVEL = { origin: [-14.1, -0.35, -12.1], voxel: 0.25, size: [114, 38, 114] };

export const DOORS = [
  { name: 'Front', low: [44, 2, 47], high: [49, 11, 49] },
  { name: 'Inner', low: [56, 2, 36], high: [57, 11, 41] },
  { name: 'Garage', low: [62, 2, 55], high: [74, 13, 57] }
];
