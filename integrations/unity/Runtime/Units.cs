namespace Brume
{
    /// <summary>Lengths and amounts of events, which are whole numbers, from metres.</summary>
    public static class Units
    {
        /// <summary>The nearest position in 1/1024 m.</summary>
        public static Position Position(double x, double y, double z)
        {
            Position position;
            Calls.Check(Native.brume_position_from_metres(x, y, z, out position));
            return position;
        }

        /// <summary>A length [m] in 1/1024 m, or a speed [m/s] in 1/1024 m/s.</summary>
        public static uint Length(double metres)
        {
            return Rounded(metres * 1024.0, 0, Limits.MaxCoordinate);
        }

        /// <summary>The number of voxels with an edge of voxelSize [m] that an amount of smoke [m^3] fills.</summary>
        public static uint SmokeVoxels(double cubicMetres, double voxelSize)
        {
            if (!(voxelSize > 0.0)) return 1;
            return Rounded(cubicMetres / (voxelSize * voxelSize * voxelSize), 1, Limits.MaxSmokeVoxels);
        }

        // As brume_rounded, which is inline in the header and not in the library.
        private static uint Rounded(double value, uint low, uint high)
        {
            if (!(value > low)) return low;
            if (value >= high) return high;
            uint whole = (uint)value;
            return value - whole >= 0.5 ? whole + 1 : whole;
        }
    }
}
