using System;
using System.Collections.Generic;
using System.Reflection;
using System.Runtime.InteropServices;
using System.Text;

namespace Brume.Tests
{
    /// <summary>What the C# declarations say of the header: lines of an expression in C and its value, which a C
    /// program has to find equal.</summary>
    internal static class Facts
    {
        // The names that script/export-csharp changes.
        private static readonly Dictionary<Type, string> renamed = new Dictionary<Type, string> {
            { typeof(WorldEvent), "brume_event" }, { typeof(MovingBody), "brume_body" },
            { typeof(SmokeTexture), "brume_texture" } };

        private static readonly Dictionary<Type, string> enumerations = new Dictionary<Type, string> {
            { typeof(Result), "BRUME" }, { typeof(Role), "BRUME_ROLE" }, { typeof(EventKind), "BRUME_EVENT" },
            { typeof(HoleShape), "BRUME_HOLE" }, { typeof(Reception), "BRUME_RECEPTION" },
            { typeof(TextureKind), "BRUME_TEXTURE" }, { typeof(SmokeTextureFormat), "BRUME_FORMAT" } };

        internal static void Print()
        {
            foreach (Type type in typeof(Native).Assembly.GetTypes())
            {
                if (type.IsEnum && type.IsPublic) PrintEnumeration(type);
                if (type.IsValueType && type.IsPublic && !type.IsEnum && type != typeof(Mask)) PrintStruct(type);
            }
            foreach (FieldInfo constant in typeof(Limits).GetFields())
                Say("BRUME_" + Snake(constant.Name).ToUpperInvariant(), constant.GetRawConstantValue());
            foreach (double metres in new[] { 0.2, 5.0, 0.00048828125, 20000.0, -1.0 })
                Say("brume_length(" + Text(metres) + ")", Units.Length(metres));
            foreach (double voxel in new[] { 0.5, 0.25, 0.0, 1e-9 })
                Say("brume_smoke_voxels(225.0, " + Text(voxel) + ")", Units.SmokeVoxels(225.0, voxel));
            PrintDefaults();
        }

        private static void Say(string expression, object value)
        {
            Console.WriteLine(expression + " = " + value);
        }

        private static string Text(double value)
        {
            return value.ToString("R", System.Globalization.CultureInfo.InvariantCulture);
        }

        private static string Snake(string name)
        {
            StringBuilder snake = new StringBuilder();
            for (int i = 0; i < name.Length; ++i)
            {
                bool number = i > 0 && char.IsDigit(name[i]) && char.IsLetter(name[i - 1]);
                if (i > 0 && (number || char.IsUpper(name[i]))) snake.Append('_');
                snake.Append(char.ToLowerInvariant(name[i]));
            }
            return snake.ToString();
        }

        private static string NameOf(Type type)
        {
            string name;
            return renamed.TryGetValue(type, out name) ? name : "brume_" + Snake(type.Name);
        }

        private static void PrintEnumeration(Type type)
        {
            foreach (object value in Enum.GetValues(type))
            {
                // Formats have no underscores.
                string name = value is SmokeTextureFormat ? value.ToString() : Snake(value.ToString());
                Say(enumerations[type] + "_" + name.ToUpperInvariant(), (int)value);
            }
        }

        private static void PrintStruct(Type type)
        {
            GCHandle.Alloc(Array.CreateInstance(type, 1), GCHandleType.Pinned).Free();  // throws unless it is blittable
            bool contents = type == typeof(WorldEventContents);  // a union without a name in C
            string name = contents ? "brume_event" : NameOf(type), path = contents ? "u." : "";
            Say(contents ? "sizeof(((brume_event*)0)->u)" : "sizeof(" + name + ")", Marshal.SizeOf(type));
            long start = contents ? Marshal.OffsetOf(typeof(WorldEvent), "U").ToInt64() : 0;
            foreach (FieldInfo member in type.GetFields())
            {
                string snake = path + Snake(member.Name);
                Say("offsetof(" + name + ", " + snake + ")", start + Marshal.OffsetOf(type, member.Name).ToInt64());
                Say("sizeof(((" + name + "*)0)->" + snake + ")", Marshal.SizeOf(member.FieldType));
            }
        }

        private static void PrintDefaults()
        {
            PrintValues("brume_voxels_defaults()", Defaults.Voxels());
            PrintValues("brume_triangles_defaults()", Defaults.Triangles());
            PrintValues("brume_world_defaults()", Defaults.World());
            PrintValues("brume_field_defaults()", Defaults.Field());
            PrintValues("brume_drawn_defaults()", Defaults.Drawn());
            PrintValues("brume_sender_defaults()", Defaults.Sender());
            PrintValues("brume_receiver_defaults()", Defaults.Receiver());
            PrintValues("brume_textures_defaults()", Defaults.Textures());
            foreach (EventKind kind in Enum.GetValues(typeof(EventKind)))
            {
                WorldEvent made = Defaults.Event(kind, 9);
                string call = "brume_event_defaults(" + (int)kind + ", 9)";
                Say(call + ".tick", made.Tick);
                if (kind == EventKind.Smoke) PrintValues(call + ".u.smoke", made.U.Smoke);
                if (kind == EventKind.Shot) PrintValues(call + ".u.shot", made.U.Shot);
                if (kind == EventKind.Blast) PrintValues(call + ".u.blast", made.U.Blast);
            }
        }

        /// <summary>The members that are numbers; floats as thousandths.</summary>
        private static void PrintValues(string expression, object values)
        {
            foreach (FieldInfo member in values.GetType().GetFields())
            {
                object value = member.GetValue(values);
                string name = expression + "." + Snake(member.Name);
                if (value is float) Say(name + " * 1000 + 0.5", (long)((float)value * 1000 + 0.5));
                else if (value is uint || value is ulong) Say(name, value);
            }
        }
    }
}
