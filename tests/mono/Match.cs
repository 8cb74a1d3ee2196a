using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Runtime.InteropServices;
using System.Text;

namespace Brume.Tests
{
    /// <summary>The input that tests/api/long_match.c prints.</summary>
    internal sealed class Match
    {
        internal readonly List<Point> Points = new List<Point>();
        internal readonly List<uint> Indices = new List<uint>();
        internal readonly List<WorldEvent> Events = new List<WorldEvent>();
        internal readonly List<Segment> Lines = new List<Segment>();
        internal uint Ticks, Every;

        internal Match(string path)
        {
            foreach (string line in File.ReadAllLines(path))
            {
                string[] words = line.Split(' ');
                if (words[0] == "point") Points.Add(PointAt(words, 1));
                else if (words[0] == "triangle") for (int i = 1; i < 4; ++i) Indices.Add(uint.Parse(words[i]));
                else if (words[0] == "event") Events.Add(EventOf(words));
                else if (words[0] == "line") Lines.Add(new Segment { A = PointAt(words, 1), B = PointAt(words, 4) });
                else if (words[0] == "play")
                {
                    Ticks = uint.Parse(words[1]);
                    Every = uint.Parse(words[2]);
                }
            }
        }

        private static Point PointAt(string[] words, int at)
        {
            CultureInfo culture = CultureInfo.InvariantCulture;
            return new Point { X = float.Parse(words[at], culture), Y = float.Parse(words[at + 1], culture),
                               Z = float.Parse(words[at + 2], culture) };
        }

        private static WorldEvent EventOf(string[] words)
        {
            WorldEvent read = Defaults.Event((EventKind)int.Parse(words[1]), uint.Parse(words[2]));
            switch ((EventKind)read.Kind)
            {
                case EventKind.Smoke: read.U.Smoke = Contents<SmokeEvent>(words); break;
                case EventKind.Shot: read.U.Shot = Contents<ShotEvent>(words); break;
                case EventKind.Blast: read.U.Blast = Contents<BlastEvent>(words); break;
                case EventKind.Move: read.U.Move = Contents<MoveEvent>(words); break;
                default: read.U.Edit = Contents<EditEvent>(words); break;
            }
            return read;
        }

        /// <summary>The members of an event are whole numbers of 32 bits.</summary>
        private static T Contents<T>(string[] words) where T : struct
        {
            T[] contents = new T[1];
            GCHandle pin = GCHandle.Alloc(contents, GCHandleType.Pinned);
            for (int i = 3; i < words.Length; ++i)
                Marshal.WriteInt32(pin.AddrOfPinnedObject(), 4 * (i - 3), int.Parse(words[i]));
            pin.Free();
            return contents[0];
        }

        internal Level Level(Context context)
        {
            return Brume.Level.FromTriangles(context, Defaults.Triangles(), Points.ToArray(), Indices.ToArray());
        }

        /// <summary>Calls `at` with the world at each tick.</summary>
        internal void Play(World world, Action<uint> at)
        {
            int next = 0;
            for (uint tick = 0; tick <= Ticks; ++tick)
            {
                for (; next < Events.Count && Events[next].Tick == tick; ++next) world.Append(Events[next]);
                world.AdvanceTo(tick);
                at(tick);
                world.ForgetBefore(tick);
            }
        }

        /// <summary>Prints the results as the C program does.</summary>
        internal void Print()
        {
            Segment[] lines = Lines.ToArray();
            float[] depths = new float[lines.Length];
            byte[] visible = new byte[lines.Length];
            using (Context context = new Context())
            using (Level level = Level(context))
            using (World world = new World(level))
            using (Field field = new Field(level))
                Play(world, tick =>
                {
                    if (tick % Every != 0) return;
                    using (State state = world.Snapshot()) field.Update(state);
                    field.OpticalDepths(lines, lines.Length, depths);
                    field.Visible(lines, lines.Length, 3, visible);
                    StringBuilder text = new StringBuilder();
                    text.AppendFormat("hash {0} {1:x16}\ndepths {0}", tick, world.Hash);
                    foreach (float depth in depths)
                        text.AppendFormat(" {0:x8}", BitConverter.ToUInt32(BitConverter.GetBytes(depth), 0));
                    text.AppendFormat("\nvisible {0} ", tick);
                    foreach (byte seen in visible) text.Append(seen);
                    Console.Out.Write(text.Append('\n'));
                });
        }
    }
}
