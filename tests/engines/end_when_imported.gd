tool
extends EditorPlugin
# Ends the editor when it has scanned the project and imported what changed. Its option --quit ends it after the first
# frame instead, also where the thread that scans is not done: then it imports nothing ("Scan thread aborted").

func _enter_tree():
	get_editor_interface().get_resource_filesystem().connect("filesystem_changed", self, "end")

func end():
	get_tree().quit()
