using System;

namespace Brume
{
    /// <summary>The simulation of a match: a log of events and the present tick.</summary>
    public sealed class World : Handle
    {
        public World(Level level) : this(level, Defaults.World())
        {
        }

        /// <param name="masks">The masks that shots may use; null: none.</param>
        public World(Level level, WorldParams settings, Masks masks = null)
        {
            using (Borrowed borrowed = new Borrowed(masks))
            {
                settings.Masks = borrowed.Pointer;
                IntPtr created;
                Calls.Check(Native.brume_world_create(level, ref settings, out created));
                SetHandle(created);
            }
        }

        /// <summary>Adds events; those of past ticks change the past.</summary>
        public void Append(params WorldEvent[] events)
        {
            Append(events, events.Length);
        }

        /// <summary>Adds the first `count` events of an array.</summary>
        public void Append(WorldEvent[] events, int count)
        {
            Calls.Check(Native.brume_world_append(this, events, Calls.Count(events, count, "events")));
        }

        /// <summary>Replaces all events at or after a tick by others of that tick or later.</summary>
        public void ReplaceFrom(uint tick, params WorldEvent[] events)
        {
            UIntPtr count = Calls.Count(events, events.Length, "events");
            Calls.Check(Native.brume_world_replace_from(this, tick, events, count));
        }

        public void AdvanceTo(uint tick)
        {
            Calls.Check(Native.brume_world_advance_to(this, tick));
        }

        public void Step()
        {
            Calls.Check(Native.brume_world_step(this));
        }

        public uint Tick
        {
            get
            {
                uint tick;
                Calls.Check(Native.brume_world_tick(this, out tick));
                return tick;
            }
        }

        public uint EarliestTick
        {
            get
            {
                uint tick;
                Calls.Check(Native.brume_world_earliest_tick(this, out tick));
                return tick;
            }
        }

        /// <summary>Drops the history before a tick. Call it every tick: memory grows otherwise.</summary>
        public void ForgetBefore(uint tick)
        {
            Calls.Check(Native.brume_world_forget_before(this, tick));
        }

        /// <summary>Equal states have equal hashes on every machine.</summary>
        public ulong Hash
        {
            get
            {
                ulong hash;
                Calls.Check(Native.brume_world_hash(this, out hash));
                return hash;
            }
        }

        /// <summary>A snapshot of the present state, to be disposed. It is cheap.</summary>
        public State Snapshot()
        {
            IntPtr state;
            Calls.Check(Native.brume_world_state(this, out state));
            return new State(state);
        }

        public void Restore(State state)
        {
            Calls.Check(Native.brume_world_restore(this, state));
        }

        protected override bool ReleaseHandle()
        {
            return Native.brume_world_destroy(handle) == Result.Ok;
        }
    }
}
