using System;

namespace Brume
{
    /// <summary>What a world is at a tick; it never changes. Lists are written into your array, which is replaced where
    /// it is too short; the result is the number of elements, which may be less than its length.</summary>
    public sealed class State : Handle
    {
        private static readonly ListCall<State, byte> save = Native.brume_state_save;
        private static readonly ListCall<State, Grenade> grenades = Native.brume_state_grenades;
        private static readonly ListCall<State, Cloud> clouds = Native.brume_state_clouds;
        private static readonly ListCall<State, Blast> blasts = Native.brume_state_blasts;
        private static readonly ListCall<State, Hole> holes = Native.brume_state_holes;
        private static readonly ListCall<State, MovingBody> bodies = Native.brume_state_bodies;

        internal State(IntPtr created)
        {
            SetHandle(created);
        }

        /// <summary>A state from the bytes that Save wrote. They need not be trusted.</summary>
        public static State Load(Context context, byte[] bytes, int size)
        {
            IntPtr state;
            Calls.Check(Native.brume_state_load(context, bytes, Calls.Count(bytes, size, "bytes"), out state));
            return new State(state);
        }

        public StateInfo Info
        {
            get
            {
                StateInfo info;
                Calls.Check(Native.brume_state_describe(this, out info));
                return info;
            }
        }

        public ulong Hash
        {
            get
            {
                ulong hash;
                Calls.Check(Native.brume_state_hash(this, out hash));
                return hash;
            }
        }

        public int Save(ref byte[] bytes)
        {
            return Calls.Fill(save, this, ref bytes);
        }

        /// <summary>A state of what reaches one of the boxes: what a client may know that sees only these.</summary>
        public State Filter(params Box[] boxes)
        {
            IntPtr filtered;
            UIntPtr count = Calls.Count(boxes, boxes.Length, "boxes");
            Calls.Check(Native.brume_state_filter(this, boxes, count, out filtered));
            return new State(filtered);
        }

        public int Grenades(ref Grenade[] items)
        {
            return Calls.Fill(grenades, this, ref items);
        }

        public int Clouds(ref Cloud[] items)
        {
            return Calls.Fill(clouds, this, ref items);
        }

        public int Blasts(ref Blast[] items)
        {
            return Calls.Fill(blasts, this, ref items);
        }

        public int Holes(ref Hole[] items)
        {
            return Calls.Fill(holes, this, ref items);
        }

        public int Bodies(ref MovingBody[] items)
        {
            return Calls.Fill(bodies, this, ref items);
        }

        protected override bool ReleaseHandle()
        {
            return Native.brume_state_destroy(handle) == Result.Ok;
        }
    }
}
