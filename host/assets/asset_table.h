#pragma once

struct lua_State;

namespace meridian::assets {

struct Asset;
class AssetGraph;

/// Makes the Lua table `asset` of one asset, and the table of its exports, and keeps both in `asset`.
void makeAssetTable(lua_State* lua, AssetGraph& graph, Asset& asset, bool enabled);

/// Gives the function on top of the stack globals of its own: `asset`, and behind it those that all share.
void setGlobals(lua_State* lua, const Asset& asset);

}  // namespace meridian::assets
