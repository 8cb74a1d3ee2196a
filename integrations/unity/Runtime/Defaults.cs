namespace Brume
{
    /// <summary>The library's defaults: change what you need and pass them on.</summary>
    public static class Defaults
    {
        public static VoxelsParams Voxels()
        {
            VoxelsParams settings;
            Calls.Check(Native.brume_voxels_params_init(out settings, SizeOf<VoxelsParams>()));
            return settings;
        }

        public static TrianglesParams Triangles()
        {
            TrianglesParams settings;
            Calls.Check(Native.brume_triangles_params_init(out settings, SizeOf<TrianglesParams>()));
            return settings;
        }

        public static WorldParams World()
        {
            WorldParams settings;
            Calls.Check(Native.brume_world_params_init(out settings, SizeOf<WorldParams>()));
            return settings;
        }

        public static FieldParams Field()
        {
            FieldParams settings;
            Calls.Check(Native.brume_field_params_init(out settings, SizeOf<FieldParams>()));
            return settings;
        }

        public static DrawnParams Drawn()
        {
            DrawnParams settings;
            Calls.Check(Native.brume_drawn_params_init(out settings, SizeOf<DrawnParams>()));
            return settings;
        }

        public static SenderParams Sender()
        {
            SenderParams settings;
            Calls.Check(Native.brume_sender_params_init(out settings, SizeOf<SenderParams>()));
            return settings;
        }

        public static ReceiverParams Receiver()
        {
            ReceiverParams settings;
            Calls.Check(Native.brume_receiver_params_init(out settings, SizeOf<ReceiverParams>()));
            return settings;
        }

        public static TexturesParams Textures()
        {
            TexturesParams settings;
            Calls.Check(Native.brume_textures_params_init(out settings, SizeOf<TexturesParams>()));
            return settings;
        }

        internal static TexturesFrame Frame()
        {
            TexturesFrame settings;
            Calls.Check(Native.brume_textures_frame_init(out settings, SizeOf<TexturesFrame>()));
            return settings;
        }

        internal static ContextParams Context()
        {
            ContextParams settings;
            Calls.Check(Native.brume_context_params_init(out settings, SizeOf<ContextParams>()));
            return settings;
        }

        /// <summary>An event of a kind at a tick. Positions are 0: set them.</summary>
        public static WorldEvent Event(EventKind kind, uint tick)
        {
            WorldEvent settings;
            Calls.Check(Native.brume_event_init(out settings, (uint)kind, tick));
            return settings;
        }

        private static uint SizeOf<T>()
        {
            return (uint)System.Runtime.InteropServices.Marshal.SizeOf(typeof(T));
        }
    }
}
