using System;
using System.Collections.Generic;

namespace Brume.Tests
{
    /// <summary>The classes over the library: errors, lists, packets and the lifetime of objects.</summary>
    internal static class CallTests
    {
        private static void Expect(bool holds, string what)
        {
            if (!holds) throw new Exception("expected: " + what);
        }

        private static T Throws<T>(Action action, string what) where T : Exception
        {
            try
            {
                action();
            }
            catch (T error)
            {
                return error;
            }
            throw new Exception("expected an exception: " + what);
        }

        internal static void Run(Match match)
        {
            ErrorsAreExceptions(match);
            ArraysAreMeasured(match);
            ObjectsAreReleased(match);
            ListsAreFilled(match);
            LevelsAndMasks();
            TexturesFollowTheField(match);
            PacketsWithLoss(match);
        }

        private static void ErrorsAreExceptions(Match match)
        {
            List<string> lines = new List<string>();
            Context context = new Context(1, (result, line) => lines.Add(result + " " + line));
            GC.Collect();  // the delegate of the callback has to outlive it
            using (Level level = match.Level(context))
            using (World world = new World(level))
            {
                WorldEvent wrong = Defaults.Event(EventKind.Smoke, 0);
                wrong.U.Smoke.Voxels = 0;
                BrumeException error = Throws<BrumeException>(() => world.Append(wrong), "no voxels");
                Expect(error.Result == Result.ErrorArgument, "an argument is wrong, not " + error.Result);
                Expect(error.Message.StartsWith("brume_world_append: ") && error.Message.Contains("voxels"),
                       "the function and the member: " + error.Message);
                Expect(lines.Count == 1 && lines[0] == "ErrorArgument " + error.Message, "the line in the log");
                context.Dispose();
                Throws<BrumeException>(() => world.Append(wrong), "no voxels, again");
                Expect(lines.Count == 1, "no call of the log after its context");
            }
            using (Context throwing = new Context(1, (result, line) => { throw new Exception(line); }))
                Throws<BrumeException>(() => State.Load(throwing, new byte[] { 1, 2, 3 }, 3), "damaged bytes");
        }

        private static void ArraysAreMeasured(Match match)
        {
            using (Context context = new Context())
            using (Level level = match.Level(context))
            using (Field field = new Field(level))
            {
                Segment[] lines = match.Lines.ToArray();
                Throws<ArgumentException>(() => field.OpticalDepths(lines, lines.Length, new float[1]), "short output");
                Throws<ArgumentException>(() => field.OpticalDepths(lines, lines.Length + 1, new float[99]),
                                          "short input");
                Throws<ArgumentException>(() => field.Visible(lines, -1, 3, new byte[1]), "a negative count");
                Voxel low = new Voxel(), high = new Voxel { X = 4, Y = 3, Z = 2 };
                Throws<ArgumentException>(() => field.Densities(low, high, new byte[23]), "23 of 24 bytes");
                field.Densities(low, high, new byte[24]);
                Throws<BrumeException>(() => field.Densities(high, low, new byte[24]), "an empty box");
                field.OpticalDepths(null, 0, null);
            }
        }

        private static void ObjectsAreReleased(Match match)
        {
            Context context = new Context();
            Level level = match.Level(context);
            World world = new World(level);
            ulong hash = world.Hash;
            level.Dispose();
            context.Dispose();
            world.Step();
            Expect(world.Tick == 1 && world.Hash != hash, "a world outlives its level and context");
            world.Dispose();
            world.Dispose();
            Throws<ObjectDisposedException>(() => world.Step(), "a disposed world");
            Throws<ObjectDisposedException>(() => new World(level), "a disposed level");
            for (int i = 0; i < 50; ++i) new Context(1, (result, line) => { });
            GC.Collect();
            GC.WaitForPendingFinalizers();
        }

        private static void ListsAreFilled(Match match)
        {
            using (Context context = new Context())
            using (Level level = match.Level(context))
            using (World world = new World(level))
            {
                world.Append(match.Events.ToArray());
                world.AdvanceTo(700);
                using (State state = world.Snapshot())
                {
                    Cloud[] clouds = null;
                    int count = state.Clouds(ref clouds);
                    Expect(count > 0 && count == state.Info.CloudCount && count == clouds.Length, "all clouds");
                    Cloud[] room = new Cloud[count + 5], same = room;
                    Expect(state.Clouds(ref room) == count && room == same, "a longer array is kept");
                    Expect(room[count - 1].Id == clouds[count - 1].Id && clouds[0].EndTick > 700, "equal clouds");
                    Hole[] holes = new Hole[1];
                    Expect(state.Holes(ref holes) == state.Info.HoleCount && holes[0].Radius1024 > 0, "all holes");
                    MovingBody[] bodies = null;
                    Expect(state.Bodies(ref bodies) == state.Info.BodyCount && bodies[0].Tick <= 700, "all bodies");
                    Blast[] blasts = null;
                    Expect(state.Blasts(ref blasts) == state.Info.BlastCount, "all blasts");
                    Grenade[] grenades = null;
                    Expect(state.Grenades(ref grenades) == state.Info.GrenadeCount, "all grenades");
                    byte[] bytes = null;
                    int size = state.Save(ref bytes);
                    using (State loaded = State.Load(context, bytes, size))
                    {
                        Expect(loaded.Hash == state.Hash, "a state from its bytes");
                        world.Restore(loaded);
                    }
                    Expect(world.Hash == state.Hash && world.EarliestTick == 700, "a restored world");
                    using (State nothing = state.Filter(new Box[0]))
                        Expect(nothing.Info.CloudCount == 0, "no clouds in no box");
                }
            }
        }

        private static void LevelsAndMasks()
        {
            using (Context context = new Context())
            {
                VoxelsParams settings = Defaults.Voxels();
                settings.Layout.Size = new Voxel { X = 16, Y = 8, Z = 16 };
                byte[] bits = new byte[16 * 8 * 16 / 8], glass = new byte[bits.Length];
                for (int i = 0; i < 2; ++i) bits[i] = glass[i] = 255;  // the first row of voxels is a pane
                bits[2] = 255;
                using (Level level = Level.FromVoxels(context, settings, bits, glass))
                {
                    byte[] roles = new byte[16 * 2];
                    level.Roles(new Voxel(), new Voxel { X = 16, Y = 2, Z = 1 }, roles);
                    Expect(roles[15] == (byte)Role.Glass && roles[16] == (byte)Role.Wall &&
                           roles[31] == (byte)Role.Ghost, "the roles of the voxels");
                    Layout layout = level.Layout;
                    Expect(layout.Size.Y == 8 && layout.VoxelSize == settings.Layout.VoxelSize, "the layout");
                    Throws<ArgumentException>(() => Level.FromVoxels(context, settings, bits, new byte[1]),
                                              "short glass");
                    Mask mask = new Mask { Width = 3, Height = 2, Texels = new byte[] { 255, 0, 255, 0, 255, 0 } };
                    using (Masks masks = new Masks(context, new[] { mask }))
                    using (World with = new World(level, Defaults.World(), masks))
                    using (World without = new World(level))
                    using (Field field = new Field(level, Defaults.Field(), masks))
                    {
                        Expect(with.Hash != without.Hash, "masks are part of the hash");
                        using (State state = without.Snapshot())
                            Expect(Throws<BrumeException>(() => field.Update(state), "other masks").Result ==
                                   Result.ErrorMismatch, "a mismatch");
                        using (State state = with.Snapshot()) field.Update(state);
                        Point eye = new Point { X = 1, Y = 1, Z = 1 }, other = new Point { X = 7, Y = 1, Z = 7 };
                        Expect(field.Visible(eye, other, 0), "clear air");
                    }
                }
            }
        }

        private static TexturesParams WithLight()
        {
            TexturesParams settings = Defaults.Textures();
            settings.LightCount = 1;
            return settings;
        }

        /// <summary>Regions tile the textures, and the first update writes the smoke.</summary>
        private static void TexturesFollowTheField(Match match)
        {
            using (Context context = new Context())
            using (Level level = match.Level(context))
            using (World world = new World(level))
            using (Field field = new Field(level))
            using (Textures textures = new Textures(field, WithLight(), Defaults.Drawn()))
            {
                TextureLight[] lights = { new TextureLight { At = new Point { X = 12, Y = 5, Z = 10 } } };
                Throws<ArgumentException>(() => textures.Update(field, 0), "no light");
                world.Append(match.Events.ToArray());
                world.AdvanceTo(300);
                using (State state = world.Snapshot()) field.Update(state);
                textures.Update(field, 300.0 / 64, lights);
                SmokeTexture[] list = new SmokeTexture[(int)TextureKind.Count];
                textures.List(list);
                byte[][] texels = new byte[list.Length][];
                for (int i = 0; i < list.Length; ++i)
                    texels[i] = new byte[list[i].Width * list[i].Height * list[i].Depth *
                                         Textures.BytesOf((SmokeTextureFormat)list[i].Format)];
                Region[] regions = null;
                int count = textures.Regions(ref regions);
                Expect(count > 0, "regions after the first update");
                for (int i = 0; i < count; ++i)
                {
                    SmokeTexture texture = list[regions[i].Texture];
                    uint size = regions[i].Width * regions[i].Height * regions[i].Depth;
                    Expect((uint)regions[i].ByteCount == size * Textures.BytesOf((SmokeTextureFormat)texture.Format),
                           "the bytes of a region");
                    textures.Copy(regions[i], texture, texels[regions[i].Texture]);
                }
                foreach (TextureKind kind in new[] { TextureKind.Density, TextureKind.Noise, TextureKind.Light })
                    Expect(Array.Exists(texels[(int)kind], value => value > 0), "texels of " + kind);
                float[] constants = new float[(int)Limits.Constants];
                textures.Constants(constants);
                Expect(!Array.Exists(constants, value => float.IsNaN(value) || float.IsInfinity(value)), "numbers");
                Throws<ArgumentException>(() => textures.Constants(new float[3]), "few constants");
                Region old = regions[0];
                textures.Update(field, 300.0 / 64, lights);
                Throws<InvalidOperationException>(() => textures.Copy(old, list[old.Texture], texels[old.Texture]),
                                                  "a region of an earlier update");
                Expect(textures.Regions(ref regions) < count, "fewer regions where nothing changed");
                Region last = regions[0];
                textures.Dispose();
                Throws<ObjectDisposedException>(() => textures.Copy(last, list[last.Texture], texels[last.Texture]),
                                                "a region of disposed textures");
            }
        }

        /// <summary>Every third packet is lost, others are swapped, and a request is answered four ticks later: the
        /// receiver has the sender's states bit for bit.</summary>
        private static void PacketsWithLoss(Match match)
        {
            Dictionary<uint, ulong> sent = new Dictionary<uint, ulong>();
            byte[] packet = null, request = null, answer = null, held = null;
            int compared = 0, answers = 0, heldSize = 0, packetBytes = 0;
            using (Context context = new Context())
            using (Level level = match.Level(context))
            using (World world = new World(level))
            using (Sender sender = new Sender(context))
            using (Receiver receiver = new Receiver(context, Defaults.Receiver(), level))
            {
                match.Play(world, tick =>
                {
                    using (State state = world.Snapshot()) sender.Push(state);
                    sent[tick] = world.Hash;
                    int size = sender.Packet(ref packet);
                    packetBytes += size;
                    if (tick % 3 == 1) return;
                    if (tick % 3 == 2 && tick % 5 == 0)
                    {
                        held = (byte[])packet.Clone();  // arrives after the next one
                        heldSize = size;
                        return;
                    }
                    receiver.Receive(packet, size);
                    if (held != null) receiver.Receive(held, heldSize);
                    held = null;
                    if (tick % 4 == 0 && receiver.Behind)
                    {
                        int asked = receiver.Request(ref request);
                        int answered = sender.Answer(request, asked, ref answer);
                        if (answered > 0) receiver.Receive(answer, answered);
                        ++answers;
                    }
                    using (State state = receiver.Snapshot())
                    {
                        Expect(state.Hash == sent[state.Info.Tick], "the sender's state of tick " + state.Info.Tick);
                        if (state.Info.Tick == tick) ++compared;
                    }
                });
                Expect(compared > 1000 && answers > 500, compared + " states and " + answers + " answers");
                Expect(Throws<BrumeException>(() => receiver.Receive(new byte[] { 1, 2, 3 }, 3), "damage").Result ==
                       Result.ErrorData, "damaged bytes");
                receiver.Reset();
                Expect(Throws<BrumeException>(() => receiver.Snapshot(), "no state").Result == Result.ErrorOrder,
                       "the order of calls");
            }
            Console.WriteLine(compared + " states equal, " + answers + " answers, " + packetBytes + " bytes");
        }
    }
}
