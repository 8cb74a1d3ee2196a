using System;

namespace Brume
{
    /// <summary>The densities of a level's smoke, and who sees whom through it. Queries may run in many threads at
    /// once, also while worlds advance. `count` is the number of segments that are used.</summary>
    public sealed class Field : Handle
    {
        private static readonly ListCall<Field, Voxel> changedBricks = Native.brume_field_changed_bricks;

        public Field(Level level) : this(level, Defaults.Field())
        {
        }

        /// <param name="masks">The masks of the worlds whose states it takes over; null: none.</param>
        public Field(Level level, FieldParams settings, Masks masks = null)
        {
            using (Borrowed borrowed = new Borrowed(masks))
            {
                settings.Masks = borrowed.Pointer;
                IntPtr created;
                Calls.Check(Native.brume_field_create(level, ref settings, out created));
                SetHandle(created);
            }
        }

        /// <summary>Takes over a state with its smoke, holes and level edits.</summary>
        public void Update(State state)
        {
            Calls.Check(Native.brume_field_update(this, state));
        }

        /// <summary>The bricks of 8^3 voxels in which the last update may have changed densities.</summary>
        public int ChangedBricks(ref Voxel[] bricks)
        {
            return Calls.Fill(changedBricks, this, ref bricks);
        }

        /// <summary>The optical depth along each segment: exp(-depth) of the light passes.</summary>
        public void OpticalDepths(Segment[] segments, int count, float[] depths)
        {
            UIntPtr queries = Queries(segments, count, depths, "depths");
            Calls.Check(Native.brume_field_optical_depths(this, segments, queries, depths));
        }

        /// <summary>1 for each segment whose ends are visible from each other: no wall lies between them, and the
        /// optical depth is at most the threshold; 3 lets 5 % of the light pass.</summary>
        public void Visible(Segment[] segments, int count, float threshold, byte[] visible)
        {
            UIntPtr queries = Queries(segments, count, visible, "visible");
            Calls.Check(Native.brume_field_visible(this, segments, queries, threshold, visible));
        }

        /// <summary>Whether two points are visible from each other.</summary>
        public bool Visible(Point a, Point b, float threshold)
        {
            Segment[] segments = { new Segment { A = a, B = b } };
            byte[] visible = new byte[1];
            Visible(segments, 1, threshold, visible);
            return visible[0] != 0;
        }

        /// <summary>As OpticalDepths, but through the smoke as it is drawn, with the gaps of its noise. Some hundred
        /// times as slow.</summary>
        public void DrawnDepths(DrawnParams look, Segment[] segments, int count, float[] depths)
        {
            UIntPtr queries = Queries(segments, count, depths, "depths");
            Calls.Check(Native.brume_field_drawn_depths(this, ref look, segments, queries, depths));
        }

        /// <summary>As Visible, but through the smoke as it is drawn.</summary>
        public void DrawnVisible(DrawnParams look, Segment[] segments, int count, float threshold, byte[] visible)
        {
            UIntPtr queries = Queries(segments, count, visible, "visible");
            Calls.Check(Native.brume_field_drawn_visible(this, ref look, segments, queries, threshold, visible));
        }

        /// <summary>The first voxel of a wall along each segment.</summary>
        public void FirstWalls(Segment[] segments, int count, Wall[] walls)
        {
            UIntPtr queries = Queries(segments, count, walls, "walls");
            Calls.Check(Native.brume_field_first_walls(this, segments, queries, walls));
        }

        /// <summary>The density of each voxel of the box [low, high), x fastest, then y, then z.</summary>
        public void Densities(Voxel low, Voxel high, byte[] densities)
        {
            UIntPtr count = Calls.Volume(low, high, densities, "densities");
            Calls.Check(Native.brume_field_densities(this, low, high, densities, count));
        }

        private static UIntPtr Queries<T>(Segment[] segments, int count, T[] results, string name)
        {
            Calls.Count(results, count, name);
            return Calls.Count(segments, count, "segments");
        }

        protected override bool ReleaseHandle()
        {
            return Native.brume_field_destroy(handle) == Result.Ok;
        }
    }
}
